#include "server/http/png.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "renderer/error.h"

namespace penumbra::server::http {

std::string pixels_only(std::string_view png) {
  constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
  constexpr std::array<std::string_view, 5> kept{"IHDR", "PLTE", "tRNS", "IDAT", "IEND"};
  constexpr std::size_t frame = 12;  // length, type and checksum around a chunk's data
  if (!png.starts_with(signature)) throw unreadable("not a PNG");
  std::string result(signature);
  for (std::size_t at = signature.size(); at < png.size();) {
    if (png.size() - at < frame) throw unreadable("the PNG ends inside a chunk");
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < 4; ++i)
      length = length << 8 | static_cast<unsigned char>(png[at + i]);
    if (length > png.size() - at - frame) throw unreadable("the PNG ends inside a chunk");
    const auto type = png.substr(at + 4, 4);
    if (std::find(kept.begin(), kept.end(), type) != kept.end())
      result += png.substr(at, frame + length);
    if (type == "IEND") return result;
    at += frame + length;
  }
  throw unreadable("the PNG has no end");
}

}  // namespace penumbra::server::http
