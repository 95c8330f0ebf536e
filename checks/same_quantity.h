#pragma once

#include "checks/record_report.h"

namespace vibrissa::checks {

/// Pairs of channels that measure the same quantity, or one the time derivative of the other, and
/// differ by the factor between two units (g, mm, degrees) or by their sign at all coherent
/// frequencies. Proven by tests/checks/same_quantity_test.cc.
void check_same_quantities(const signals::Record& record, std::vector<Finding>& findings);

}  // namespace vibrissa::checks
