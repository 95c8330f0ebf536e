#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace vibrissa::signals {

/// An error in the input of the user. The message says what is wrong, where (file, line, parameter)
/// and what to do. Programs print it and end with exit status 2.
class UserError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the machine could not give: memory, room on a disk, a file that could not be written. The
/// message says what and where. Programs print it and end with exit status 74.
class ResourceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A computation or a library call that failed although the input was accepted. Programs ask for a
/// report and end with exit status 70.
class InternalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The known name that is most similar to the given name, ignoring case; empty when none is
/// similar.
std::string nearest_name(const std::string& given, const std::vector<std::string>& known);

/// "unknown <kind> '<given>'; did you mean '<nearest>'? Known: a, b, c" for messages about names.
/// There is no hint when no known name is similar. Proven by tests/signals/base/error_test.cc.
std::string unknown_name(const std::string& kind, const std::string& given,
                         const std::vector<std::string>& known);

}  // namespace vibrissa::signals
