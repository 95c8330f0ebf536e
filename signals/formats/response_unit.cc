#include "signals/formats/response_unit.h"

#include "signals/base/error.h"
#include "signals/base/unit.h"

namespace vibrissa::signals::formats {

ResponseUnit response_unit(const std::string& stated, const std::string& wanted,
                           const bool may_keep, const std::string& file) {
  if (stated.empty())
    return {.unit = wanted,
            .words = "frequency response, the file states no unit: taken as " + wanted};
  try {
    return {.scale = convert_unit(stated, wanted).scale,
            .unit = wanted,
            .words = "frequency response, unit " + stated + " of the file, converted to " + wanted};
  } catch (const UnitError& error) {
    const std::string advice =
        "give the conversion factor, as in '[" + stated + "]*FACTOR[unit]' or '[uT/g]*0.18[N m/T]'";
    if (!may_keep)
      throw UserError(file + ": the response is in " + stated + ": " + error.what() + "; " +
                      advice);
    return {.unit = stated,
            .words = "frequency response, unit " + stated +
                     " of the file, not converted: it measures no moment per acceleration. "
                     "Frequencies and damping do not depend on it; gains are in " +
                     stated + ". For " + wanted + " " + advice};
  }
}

}  // namespace vibrissa::signals::formats
