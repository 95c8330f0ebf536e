#pragma once

#include <deal.II/base/parameter_handler.h>

#include "case/case_file.h"

namespace vibrissa::sensor_case {

/// Declares every entry of a case file, with units and ranges.
void declare_case(dealii::ParameterHandler& prm);
/// Reads the values of the entries; throws UserError for inconsistent values.
Case parse_case(dealii::ParameterHandler& prm);

}  // namespace vibrissa::sensor_case
