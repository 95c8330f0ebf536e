#include "signals/base/utf_8.h"

#include <algorithm>
#include <cstddef>

namespace vibrissa::signals {
namespace {

// Length of the UTF-8 character at the start of the text; 0: none.
std::size_t utf_8_length(const std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = first < 0x80             ? 1
                             : (first & 0xE0) == 0xC0 ? 2
                             : (first & 0xF0) == 0xE0 ? 3
                             : (first & 0xF8) == 0xF0 ? 4
                                                      : 0;
  if (length == 0 || length > text.size()) return 0;
  const auto is_next = [](const char c) { return (c & 0xC0) == 0x80; };
  return std::all_of(text.begin() + 1, text.begin() + std::ptrdiff_t(length), is_next) ? length : 0;
}

}  // namespace

void append_utf_8(const std::uint32_t code, std::string& text) {
  const auto put = [&](const std::uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) return put(code);
  if (code < 0x800) {
    put(0xC0 | code >> 6);
  } else if (code < 0x10000) {
    put(0xE0 | code >> 12);
    put(0x80 | (code >> 6 & 0x3F));
  } else {
    put(0xF0 | code >> 18);
    put(0x80 | (code >> 12 & 0x3F));
    put(0x80 | (code >> 6 & 0x3F));
  }
  put(0x80 | (code & 0x3F));
}

std::string as_utf_8(const std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf_8_length(text.substr(at));
    if (length == 0) {
      std::string converted;
      for (const char c : text) append_utf_8(static_cast<unsigned char>(c), converted);
      return converted;
    }
    at += length;
  }
  return std::string(text);
}

}  // namespace vibrissa::signals
