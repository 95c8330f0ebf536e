#pragma once

#include <filesystem>
#include <string>

namespace vibrissa::signals {

/// An encrypted text and a commitment to it: AES-256-GCM with a random key, and the SHA-256 of salt
/// and text, which proves later that the text was not changed.
struct Seal {
  std::string cipher;      // hex: nonce, text, tag
  std::string key;         // hex: key and salt; stored in another place
  std::string commitment;  // hex
};

/// Proven by tests/signals/system/sealed_file_test.cc.
Seal seal(const std::string& text);

/// Decrypts the text. Throws UserError when the key is invalid or wrong, when the cipher was
/// changed, and when the text differs from the commitment.
std::string unseal(const Seal& seal);

}  // namespace vibrissa::signals
