#pragma once

#include <string>

namespace vibrissa::signals::formats {

/// Factor to the unit that is needed, the unit behind it, and both in words.
struct ResponseUnit {
  double scale = 1.;
  std::string unit{}, words{};
};

/// From the unit that the file states for the values (empty: none, so that they are taken as the
/// wanted one). Throws UserError for a unit of another quantity, unless it may be kept. Proven by
/// tests/signals/formats/response_reader_test.cc.
ResponseUnit response_unit(const std::string& stated, const std::string& wanted, bool may_keep,
                           const std::string& file);

}  // namespace vibrissa::signals::formats
