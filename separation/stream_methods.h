#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "separation/filters/fdaf.h"
#include "separation/filters/separator.h"

namespace vibrissa::separation {

/// A separator that adapts to the record sample by sample, needs no model, and makes no quiet
/// stretch louder (see NotLouder).
struct StreamMethod {
  std::string name;   // name for the user, also of the result column
  std::string about;  // one line of description
  std::function<std::unique_ptr<Separator>(const FdafOptions&)> make;
};

/// All methods. The options set the lengths and steps of the methods that have them; all other
/// parameters have the defaults of the method.
const std::vector<StreamMethod>& stream_methods();

/// Throws UserError that lists the known names.
const StreamMethod& stream_method(const std::string& name);

}  // namespace vibrissa::separation
