#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "separation/filters/fdaf.h"
#include "separation/filters/separator.h"

namespace vibrissa::separation {

/// A separator that learns from the record alone, sample by sample.
struct StreamMethod {
  std::string name;   // as a user gives it, and of its column
  std::string about;  // a line
  std::function<std::unique_ptr<Separator>(const FdafOptions&)> make;
};

/// All of them. Lengths and steps of the frequency-domain filters follow the options where they
/// have such a thing; everything else is the method's default.
const std::vector<StreamMethod>& stream_methods();

/// Throws UserError that lists the known names.
const StreamMethod& stream_method(const std::string& name);

}  // namespace vibrissa::separation
