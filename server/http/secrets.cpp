#include "server/http/secrets.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <spdlog/spdlog.h>

#include <cstring>
#include <set>
#include <vector>

#include "renderer/error.h"
#include "server/storage/data_folder.h"

namespace penumbra::server::http {
namespace {

std::vector<unsigned char> random_numbers(std::size_t count) {
  const auto bytes = random_bytes(count);
  return {bytes.begin(), bytes.end()};
}

/// Who may write the file chooses the token; who may read it has it.
void check_permissions(const std::filesystem::path& file) {
  using std::filesystem::perms;
  const auto granted = std::filesystem::status(file).permissions();
  const auto others = [&](perms group, perms world) {
    return (granted & (group | world)) != perms::none;
  };
  if (others(perms::group_write, perms::others_write))
    throw bad_value("token_file", file.string() + " can be changed by others; chmod 600 it");
  if (others(perms::none, perms::others_read))
    spdlog::warn("{} can be read by everybody on this machine; chmod 600 it", file.string());
}

}  // namespace

std::string random_token(std::size_t bytes) {
  const auto raw = random_numbers(bytes);
  std::string text(4 * ((bytes + 2) / 3) + 1, '\0');
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), raw.data(),
                                     static_cast<int>(bytes));
  text.resize(static_cast<std::size_t>(length));
  while (!text.empty() && text.back() == '=') text.pop_back();
  for (auto& c : text) c = c == '+' ? '-' : c == '/' ? '_' : c;
  return text;
}

std::uint64_t random_seed() {
  const auto raw = random_numbers(sizeof(std::uint64_t));
  std::uint64_t value = 0;
  std::memcpy(&value, raw.data(), sizeof value);
  return value >> 11;
}

std::string random_uuid() {
  auto raw = random_numbers(16);
  raw[6] = static_cast<unsigned char>((raw[6] & 0x0f) | 0x40);
  raw[8] = static_cast<unsigned char>((raw[8] & 0x3f) | 0x80);
  const auto digits = hexadecimal({reinterpret_cast<const char*>(raw.data()), raw.size()});
  return digits.substr(0, 8) + "-" + digits.substr(8, 4) + "-" + digits.substr(12, 4) + "-" +
         digits.substr(16, 4) + "-" + digits.substr(20);
}

namespace {

constexpr std::string_view code_alphabet = "23456789ABCDEFGHJKMNPQRSTUVWXYZ";
constexpr std::size_t code_group = 5;

}  // namespace

std::string random_code(std::size_t groups) {
  // Bytes at or above the largest multiple of the alphabet's size would favour its first letters.
  constexpr unsigned fair = 256 - 256 % code_alphabet.size();
  std::string code;
  while (code.size() < groups * code_group) {
    const unsigned value = random_numbers(1).front();
    if (value < fair) code += code_alphabet[value % code_alphabet.size()];
  }
  return code_as_written(code);
}

std::string code_as_written(std::string_view typed) {
  std::string code;
  for (const char letter : typed) {
    const char upper =
        letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
    if (code_alphabet.find(upper) == std::string_view::npos) continue;
    if (code.size() % (code_group + 1) == code_group) code += '-';
    code += upper;
  }
  return code;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string researcher_token(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file))
    storage::write_file_durably(file, random_token() + "\n", 0600);
  check_permissions(file);
  std::string token = storage::read_file(file);
  while (!token.empty() && (token.back() == '\n' || token.back() == '\r' || token.back() == ' '))
    token.pop_back();
  constexpr std::size_t shortest = 16;
  constexpr std::size_t least_distinct = 6;  // of characters; equal or alternating ones are guessed
  const std::set<char> distinct(token.begin(), token.end());
  if (token.size() < shortest || distinct.size() < least_distinct)
    throw bad_value("token_file", file.string() +
                                      " must hold a token of at least 16 characters, six of them "
                                      "different");
  return token;
}

}  // namespace penumbra::server::http
