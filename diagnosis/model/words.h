#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vibrissa::diagnosis {

std::string joined(const std::vector<std::string>& words, const std::string& separator);

/// The value with at most that many significant digits.
std::string with_digits(double value, int digits);

/// The value with at most three significant digits.
std::string three_digits(double value);

/// The value with at most one decimal: "-12.3", "5".
std::string one_decimal(double value);

/// 0.123 as "12 %", 0.0123 as "1.2 %", 0.03 as "3 %".
std::string percent(double share);

/// Breaks a text at spaces into lines of at most 100 characters; "5 %", "1 .. 2" and "1 -> 2" stay
/// together; all lines but the first are indented. A
/// text longer than most_lines is cut after a whole word and ends in dots. Proven by
/// tests/diagnosis/model/words_test.cc.
std::vector<std::string> wrapped(const std::string& line, std::size_t most_lines = 1000,
                                 std::size_t indentation = 4);

}  // namespace vibrissa::diagnosis
