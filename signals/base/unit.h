#pragma once

#include <string>

#include "signals/base/error.h"

namespace vibrissa::signals {

/// Value in the target unit = scale * value + offset.
struct UnitConversion {
  double scale = 1.;
  double offset = 0.;
};

/// A unit that is not known, or measures something else.
class UnitError : public UserError {
 public:
  using UserError::UserError;
};

/// From one unit to another that measures the same: "mN mm" to "N m", "km/h" to "m/s", "degC" to
/// "K". Spelling as UDUNITS-2 reads it (https://www.unidata.ucar.edu/software/udunits), with "Nm",
/// "mps" and their like taken, too; g, mg and ug are those of gravity where a mass would make no
/// sense. Throws UnitError for a unit that is not known and for one that measures something else.
/// Proven by tests/signals/base/unit_test.cc.
UnitConversion convert_unit(const std::string& from, const std::string& to);

}  // namespace vibrissa::signals
