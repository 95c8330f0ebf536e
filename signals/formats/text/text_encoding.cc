#include "signals/formats/text/text_encoding.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <system_error>

#include "signals/base/error.h"
#include "signals/base/utf_8.h"

namespace vibrissa::signals::formats {
namespace {

enum class Order { none, little, big };

// By the mark, or by the zeros that ASCII characters have in UTF-16.
Order order_of_utf_16(const FileBytes& bytes) {
  std::array<char, 4096> head{};
  const std::size_t n = bytes.read(0, head.data(), head.size());
  const std::string_view text(head.data(), n);
  if (text.starts_with("\xFF\xFE")) return Order::little;
  if (text.starts_with("\xFE\xFF")) return Order::big;
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < n; ++i) zeros[i % 2] += text[i] == '\0';
  const auto is_most = [&](const std::size_t count) { return 5 * count > 2 * n; };
  if (n < 8 || is_most(zeros[0]) == is_most(zeros[1])) return Order::none;
  return is_most(zeros[1]) ? Order::little : Order::big;
}

std::string utf_8_of_utf_16(const std::string& raw, const Order order) {
  const auto unit = [&](const std::size_t i) -> std::uint32_t {
    const auto a = static_cast<unsigned char>(raw[i]), b = static_cast<unsigned char>(raw[i + 1]);
    return order == Order::little ? a | b << 8 : a << 8 | b;
  };
  std::string text;
  text.reserve(raw.size() / 2);
  for (std::size_t i = 0; i + 1 < raw.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (i == 0 && code == 0xFEFF) continue;
    const bool is_first_of_two = code >= 0xD800 && code < 0xDC00 && i + 3 < raw.size();
    if (is_first_of_two) {
      code = 0x10000 + ((code - 0xD800) << 10) + ((unit(i + 2) - 0xDC00) & 0x3FF);
      i += 2;
    }
    append_utf_8(code, text);
  }
  return text;
}

std::string all_of(const FileBytes& bytes) {
  constexpr std::size_t block = std::size_t{1} << 20;
  std::string all;
  for (;;) {
    const std::size_t held = all.size();
    all.resize(held + block);
    const std::size_t n = bytes.read(held, all.data() + held, block);
    all.resize(held + n);
    if (n < block) return all;
  }
}

}  // namespace

OpenedText open_text(const std::filesystem::path& file) {
  if (std::error_code ignored; std::filesystem::is_directory(file, ignored))
    throw UserError(file.string() + ": this is a folder, not a text file");
  FileBytes bytes(file);
  if (const Order order = order_of_utf_16(bytes); order != Order::none)
    return {FileBytes(file, utf_8_of_utf_16(all_of(bytes), order)), 0, true};
  const std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::string mark(byte_order_mark.size(), ' ');
  bytes.read(0, mark.data(), mark.size());
  return {std::move(bytes), mark == byte_order_mark ? mark.size() : 0, false};
}

}  // namespace vibrissa::signals::formats
