#pragma once

#include <string>
#include <vector>

namespace vibrissa::diagnosis {

std::string joined(const std::vector<std::string>& words, const std::string& separator);

/// At three significant digits.
std::string three_digits(double value);

}  // namespace vibrissa::diagnosis
