#include "report/text/base64.h"

#include <openssl/evp.h>

#include <algorithm>
#include <limits>

namespace vibrissa::report {

std::string base64(const std::span<const std::byte> bytes) {
  // The library counts in int, so groups of three bytes are encoded piece by piece.
  constexpr std::size_t piece = 3 * (std::size_t{1} << 20);
  static_assert(piece < std::numeric_limits<int>::max());
  std::string text;
  std::string block(4 * (piece / 3) + 1, ' ');
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    const auto part = bytes.subspan(at, std::min(piece, bytes.size() - at));
    const int n = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(block.data()),
                                  reinterpret_cast<const unsigned char*>(part.data()),
                                  static_cast<int>(part.size()));
    text.append(block, 0, static_cast<std::size_t>(n));
  }
  return text;
}

}  // namespace vibrissa::report
