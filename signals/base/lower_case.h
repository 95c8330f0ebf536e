#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace vibrissa::signals {

/// ASCII letters in lower case, all else as it is.
inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace vibrissa::signals
