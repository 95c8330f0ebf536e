#pragma once

#include <string>

#include "signals/base/error.h"

namespace vibrissa::signals {

/// Value in the target unit = scale * value + offset.
struct UnitConversion {
  double scale = 1.;
  double offset = 0.;
};

/// A unit that is unknown, or that measures another quantity.
class UnitError : public UserError {
 public:
  using UserError::UserError;
};

/// Conversion between two units of the same quantity: "mN mm" to "N m", "km/h" to "m/s", "degC" to
/// "K". The spelling is that of UDUNITS-2 (https://www.unidata.ucar.edu/software/udunits); "Nm",
/// "mps" and similar spellings are also accepted. g, mg and ug mean the acceleration of gravity
/// where a mass is not possible. Throws UnitError for an unknown unit and for a unit of another
/// quantity. Proven by tests/signals/base/unit_test.cc.
UnitConversion convert_unit(const std::string& from, const std::string& to);

/// Whether the text is a unit: "m/s^2", "mN mm", "Volts"; a number alone is none.
bool is_unit(const std::string& text);

}  // namespace vibrissa::signals
