#include "server/jobs/digest.h"

#include <openssl/evp.h>

#include <array>

#include "renderer/error.h"

namespace penumbra::server {

std::string sha256(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> raw{};
  unsigned length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), raw.data(), &length, EVP_sha256(), nullptr) != 1)
    throw Error("internal", "the cryptography library offers no SHA-256");
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  text.reserve(2 * length);
  for (unsigned i = 0; i < length; ++i) {
    text.push_back(digits[raw[i] >> 4]);
    text.push_back(digits[raw[i] & 15]);
  }
  return text;
}

}  // namespace penumbra::server
