#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace vibrissa::separation {

/// A value as a C constant of single precision.
inline std::string c_number(double value) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%.9ef", value);
  return text.data();
}

inline void replace_all(std::string& text, const std::string& word, const std::string& by) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at))
    text.replace(at, word.size(), by), at += by.size();
}

}  // namespace vibrissa::separation
