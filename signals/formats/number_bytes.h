#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace vibrissa::signals::formats {

static_assert(std::endian::native == std::endian::little ||
              std::endian::native == std::endian::big);

/// The number that is stored at this address in this byte order. Proven by tests/signals/formats,
/// which read both orders.
template <typename Number>
Number number_at(const char* const from, const std::endian order) {
  std::array<char, sizeof(Number)> bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = from[order == std::endian::native ? i : bytes.size() - 1 - i];
  return std::bit_cast<Number>(bytes);
}

}  // namespace vibrissa::signals::formats
