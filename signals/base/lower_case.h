#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace vibrissa::signals {

/// The text with ASCII letters in lower case.
inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace vibrissa::signals
