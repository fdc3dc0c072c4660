#include "study/digest.h"

#include <openssl/evp.h>

#include "renderer/error.h"

namespace penumbra::study {

std::string hexadecimal(std::string_view bytes) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  text.reserve(2 * bytes.size());
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text.push_back(digits[byte >> 4]);
    text.push_back(digits[byte & 15]);
  }
  return text;
}

std::string sha256(std::string_view bytes) {
  std::string raw(EVP_MAX_MD_SIZE, '\0');
  unsigned length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), reinterpret_cast<unsigned char*>(raw.data()), &length,
                 EVP_sha256(), nullptr) != 1)
    throw Error("internal", "the cryptography library offers no SHA-256");
  return hexadecimal(std::string_view(raw).substr(0, length));
}

}  // namespace penumbra::study
