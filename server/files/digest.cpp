#include "server/files/digest.h"

#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include "renderer/error.h"

namespace penumbra::server {

std::string keyed_digest(std::string_view key, std::string_view text) {
  std::string raw(EVP_MAX_MD_SIZE, '\0');
  unsigned length = 0;
  HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
       reinterpret_cast<const unsigned char*>(text.data()), text.size(),
       reinterpret_cast<unsigned char*>(raw.data()), &length);
  return hexadecimal(std::string_view(raw).substr(0, length));
}

std::string random_bytes(std::size_t count) {
  std::string bytes(count, '\0');
  if (RAND_bytes(reinterpret_cast<unsigned char*>(bytes.data()), static_cast<int>(count)) != 1)
    throw Error("storage", "the system's random source failed");
  return bytes;
}

}  // namespace penumbra::server
