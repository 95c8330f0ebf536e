#include "signals/system/sealed_file.h"

#include <openssl/evp.h>
#include <openssl/rand.h>

#include <array>
#include <memory>
#include <vector>

#include "signals/base/error.h"
#include "signals/system/sha256.h"

namespace vibrissa::signals {
namespace {

using Bytes = std::vector<unsigned char>;
constexpr std::size_t key_size = 32, salt_size = 32, nonce_size = 12, tag_size = 16;

struct FreeCipher {
  void operator()(EVP_CIPHER_CTX* context) const { EVP_CIPHER_CTX_free(context); }
};
using Cipher = std::unique_ptr<EVP_CIPHER_CTX, FreeCipher>;

void require(const int done) {
  if (done != 1) throw InternalError("the encryption library (OpenSSL) failed");
}

Bytes from_hex(const std::string& text, const std::string& what) {
  const auto digit = [&](char c) -> int {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    throw UserError(what + " contains a character that is not a hexadecimal digit");
  };
  if (text.size() % 2 != 0) throw UserError(what + " is cut off");
  Bytes out;
  for (std::size_t i = 0; i < text.size(); i += 2)
    out.push_back(static_cast<unsigned char>(16 * digit(text[i]) + digit(text[i + 1])));
  return out;
}

Bytes random_bytes(const std::size_t n) {
  Bytes out(n);
  require(RAND_bytes(out.data(), static_cast<int>(n)));
  return out;
}

std::string commitment_of(const Bytes& salt, const std::string& text) {
  Sha256 digest;
  digest.add(salt.data(), salt.size());
  digest.add(text.data(), text.size());
  return digest.hex();
}

}  // namespace

Seal seal(const std::string& text) {
  const Bytes key = random_bytes(key_size), salt = random_bytes(salt_size),
              nonce = random_bytes(nonce_size);
  const Cipher cipher(EVP_CIPHER_CTX_new());
  require(EVP_EncryptInit_ex(cipher.get(), EVP_aes_256_gcm(), nullptr, key.data(), nonce.data()));
  Bytes out(text.size()), tag(tag_size);
  int n = 0;
  require(EVP_EncryptUpdate(cipher.get(), out.data(), &n,
                            reinterpret_cast<const unsigned char*>(text.data()),
                            static_cast<int>(text.size())));
  require(EVP_EncryptFinal_ex(cipher.get(), out.data() + n, &n));
  require(EVP_CIPHER_CTX_ctrl(cipher.get(), EVP_CTRL_GCM_GET_TAG, tag_size, tag.data()));
  return {to_hex(nonce) + to_hex(out) + to_hex(tag), to_hex(key) + to_hex(salt),
          commitment_of(salt, text)};
}

std::string unseal(const Seal& seal) {
  const Bytes key = from_hex(seal.key, "the key"), all = from_hex(seal.cipher, "the sealed text");
  if (key.size() != key_size + salt_size) throw UserError("this is not a key: its length is wrong");
  if (all.size() < nonce_size + tag_size) throw UserError("the sealed text is cut off");
  const Bytes salt(key.begin() + key_size, key.end());
  Bytes tag(all.end() - tag_size, all.end());
  const std::size_t length = all.size() - nonce_size - tag_size;
  const Cipher cipher(EVP_CIPHER_CTX_new());
  require(EVP_DecryptInit_ex(cipher.get(), EVP_aes_256_gcm(), nullptr, key.data(), all.data()));
  std::string text(length, '\0');
  int n = 0;
  auto* out = reinterpret_cast<unsigned char*>(text.data());
  require(
      EVP_DecryptUpdate(cipher.get(), out, &n, all.data() + nonce_size, static_cast<int>(length)));
  require(EVP_CIPHER_CTX_ctrl(cipher.get(), EVP_CTRL_GCM_SET_TAG, tag_size, tag.data()));
  if (EVP_DecryptFinal_ex(cipher.get(), out + n, &n) != 1)
    throw UserError("the sealed text cannot be opened: the key is wrong, or the text was changed");
  if (commitment_of(salt, text) != seal.commitment)
    throw UserError("the sealed text differs from the text of the commitment");
  return text;
}

}  // namespace vibrissa::signals
