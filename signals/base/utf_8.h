#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vibrissa::signals {

/// Appends the character with this code.
void append_utf_8(std::uint32_t code, std::string& text);

/// Text as UTF-8: bytes that are not UTF-8 are taken as latin-1. Proven by
/// tests/signals/formats/text_file_test.cc.
std::string as_utf_8(std::string_view text);

}  // namespace vibrissa::signals
