#include "server/http/png.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "renderer/error.h"

namespace penumbra::server::http {
namespace {

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);

struct Chunk {
  std::string_view type;
  std::string_view data;
  std::string_view whole;  ///< with length, type and checksum
};

/// Four bytes, the highest first.
std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (const char byte : bytes.substr(at, 4))
    number = number << 8 | static_cast<unsigned char>(byte);
  return number;
}

/// The chunks that pixels depend on, in order, from IHDR to IEND.
std::vector<Chunk> chunks_of_pixels(std::string_view png) {
  constexpr std::array<std::string_view, 5> kept{"IHDR", "PLTE", "tRNS", "IDAT", "IEND"};
  constexpr std::size_t frame = 12;  // length, type and checksum around a chunk's data
  if (!png.starts_with(signature)) throw unreadable("not a PNG");
  std::vector<Chunk> chunks;
  for (std::size_t at = signature.size(); at < png.size();) {
    if (png.size() - at < frame) throw unreadable("the PNG ends inside a chunk");
    const std::uint32_t length = number_at(png, at);
    if (length > png.size() - at - frame) throw unreadable("the PNG ends inside a chunk");
    const auto type = png.substr(at + 4, 4);
    if (std::find(kept.begin(), kept.end(), type) != kept.end())
      chunks.push_back({type, png.substr(at + 8, length), png.substr(at, frame + length)});
    if (type == "IEND") return chunks;
    at += frame + length;
  }
  throw unreadable("the PNG has no end");
}

const Bytef* bytes_of(std::string_view text) {
  return reinterpret_cast<const Bytef*>(text.data());
}

std::string inflated(std::string_view packed) {
  z_stream stream{};
  stream.next_in = const_cast<Bytef*>(bytes_of(packed));
  stream.avail_in = static_cast<uInt>(packed.size());
  if (::inflateInit(&stream) != Z_OK) throw Error("internal", "zlib cannot be started");
  std::string all;
  std::string block(std::size_t{1} << 18, '\0');
  int state = Z_OK;
  while (state == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.avail_out = static_cast<uInt>(block.size());
    state = ::inflate(&stream, Z_NO_FLUSH);
    all.append(block, 0, block.size() - stream.avail_out);
  }
  ::inflateEnd(&stream);
  if (state != Z_STREAM_END) throw unreadable("the pixels of the PNG are damaged");
  return all;
}

std::string deflated(std::string_view bytes) {
  uLongf size = ::compressBound(bytes.size());
  std::string packed(size, '\0');
  if (::compress2(reinterpret_cast<Bytef*>(packed.data()), &size, bytes_of(bytes), bytes.size(),
                  Z_BEST_COMPRESSION) != Z_OK)
    throw Error("internal", "zlib cannot pack a picture");
  packed.resize(size);
  return packed;
}

std::string big_endian(std::uint32_t value) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 255);
  return text;
}

}  // namespace

std::string pixels_only(std::string_view png) {
  std::string result(signature);
  for (const auto& chunk : chunks_of_pixels(png)) result += chunk.whole;
  return result;
}

std::pair<std::uint32_t, std::uint32_t> size_of_png(std::string_view png) {
  const auto chunks = chunks_of_pixels(png);
  if (chunks.front().type != "IHDR" || chunks.front().data.size() < 8)
    throw unreadable("the PNG has no size");
  return {number_at(chunks.front().data, 0), number_at(chunks.front().data, 4)};
}

std::string packed_tightly(std::string_view png) {
  const auto chunks = chunks_of_pixels(png);
  // The stream of pixels may be cut anywhere into chunks (W3C PNG, 11.2.3): here it is one.
  std::string stream;
  for (const auto& chunk : chunks)
    if (chunk.type == "IDAT") stream += chunk.data;
  const auto tagged = "IDAT" + deflated(inflated(stream));
  const auto checksum = ::crc32(0, bytes_of(tagged), static_cast<uInt>(tagged.size()));
  std::string result(signature);
  bool written = false;
  for (const auto& chunk : chunks) {
    if (chunk.type != "IDAT") {
      result += chunk.whole;
    } else if (!written) {
      result += big_endian(static_cast<std::uint32_t>(tagged.size() - 4)) + tagged +
                big_endian(static_cast<std::uint32_t>(checksum));
      written = true;
    }
  }
  return result;
}

}  // namespace penumbra::server::http
