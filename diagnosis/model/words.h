#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vibrissa::diagnosis {

std::string joined(const std::vector<std::string>& words, const std::string& separator);

/// At three significant digits.
std::string three_digits(double value);

/// 0.123 as "12 %", 0.0123 as "1.2 %".
std::string percent(double share);

/// As lines of at most 100 characters, broken at spaces; those behind the first are indented. What
/// does not fit into most_lines ends in dots behind a whole word. Proven by
/// tests/diagnosis/model/words_test.cc.
std::vector<std::string> wrapped(const std::string& line, std::size_t most_lines = 1000);

}  // namespace vibrissa::diagnosis
