#pragma once

#include <string>
#include <vector>

namespace vibrissa::diagnosis {

std::string joined(const std::vector<std::string>& words, const std::string& separator);

/// At three significant digits.
std::string three_digits(double value);

/// 0.123 as "12 %", 0.0123 as "1.2 %".
std::string percent(double share);

/// A line of at most 100 characters, or two, broken at a space; what is longer ends in dots.
std::vector<std::string> wrapped(const std::string& line);

}  // namespace vibrissa::diagnosis
