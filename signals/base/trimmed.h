#pragma once

#include <string_view>

namespace vibrissa::signals {

/// The text without the blanks (spaces, tabs, carriage returns) at both ends; a view of the given
/// text.
inline std::string_view trimmed(const std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

}  // namespace vibrissa::signals
