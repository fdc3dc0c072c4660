#include "scenes/text.h"

#include "scenes/json_text.h"

namespace penumbra::scenes {
namespace {

constexpr std::size_t longest_quote = 100;  // bytes

}  // namespace

std::string valid_text(const std::string& text) {
  bool ascii = true;
  for (const char c : text) ascii = ascii && static_cast<unsigned char>(c) < 0x80;
  if (ascii) return text;
  // The JSON library replaces what is no UTF-8 when it writes.
  return nlohmann::json::parse(json_text(text));
}

std::string shortened(const std::string& text, std::size_t longest) {
  if (text.size() <= longest) return valid_text(text);
  std::size_t end = longest;
  // Do not cut inside a character.
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) --end;
  return valid_text(text.substr(0, end)) + "...";
}

std::string in_quotes(const std::string& text) {
  return "'" + shortened(text, longest_quote) + "'";
}

}  // namespace penumbra::scenes
