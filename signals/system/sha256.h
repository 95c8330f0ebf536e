#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace vibrissa::signals {

/// Bytes as hexadecimal digits, two for each byte, lower case.
std::string to_hex(std::span<const unsigned char> bytes);

/// SHA-256 (FIPS 180-4) of bytes that are added piece by piece. Proven by
/// tests/signals/system/sha256_test.cc.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(const void* bytes, std::size_t n);
  /// Digest of all added bytes; nothing can be added after this call.
  std::string hex();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

std::string sha256(std::string_view text);

}  // namespace vibrissa::signals
