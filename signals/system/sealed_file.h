#pragma once

#include <filesystem>
#include <string>

namespace vibrissa::signals {

/// A text that is on record before anybody may read it: AES-256-GCM under a random key, and the
/// SHA-256 of salt and text, which commits its author to it.
struct Seal {
  std::string cipher;      // hex: nonce, text, tag
  std::string key;         // hex: key and salt; kept elsewhere
  std::string commitment;  // hex
};

/// Proven by tests/signals/system/sealed_file_test.cc.
Seal seal(const std::string& text);

/// The text again. Throws UserError when the key is none or another's, when the cipher was changed,
/// and when the text is not the one that was committed to.
std::string unseal(const Seal& seal);

}  // namespace vibrissa::signals
