#pragma once

#include <string>

#include "checks/check_file.h"

namespace vibrissa::checks {

/// What `vibrissa check` prints: each record, its channels and findings, then one table of the
/// commands.
std::string check_text(const CheckResult& result);

}  // namespace vibrissa::checks
