#pragma once

#include <cstddef>
#include <string>

namespace vibrissa::signals {

/// Data rows of a file, counted from 1.
struct RowRange {
  std::size_t first = 1, count = 0;
};

/// Parses FIRST:LAST. Throws UserError that names the option. Proven by
/// tests/apps/bad_input_test.cc.
RowRange parse_rows(const std::string& text, const std::string& option);

}  // namespace vibrissa::signals
