#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra::server::http {

inline std::string big_endian(std::uint32_t value) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 255);
  return text;
}

/// A PNG chunk: length, type, data, checksum over type and data (W3C PNG, 5.3).
inline std::string chunk(const std::string& type, const std::string& data) {
  const auto checked = type + data;
  const auto sum =
      ::crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + checked +
         big_endian(static_cast<std::uint32_t>(sum));
}

inline std::string compressed(const std::string& bytes) {
  uLongf size = ::compressBound(bytes.size());
  std::string packed(size, '\0');
  ::compress(reinterpret_cast<Bytef*>(packed.data()), &size,
             reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  packed.resize(size);
  return packed;
}

/// A 4x4 picture of one grey value that says in a text chunk what made it.
inline std::string grey_png(std::uint8_t grey, const std::string& text) {
  std::string rows;
  for (int y = 0; y < 4; ++y) rows += '\0' + std::string(4, static_cast<char>(grey));
  const std::string header = big_endian(4) + big_endian(4) + std::string("\x08\0\0\0\0", 5);
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) +
         chunk("tEXt", std::string("Software\0", 9) + text) + chunk("IDAT", compressed(rows)) +
         chunk("IEND", "");
}

/// Types of the chunks in a file, in order.
inline std::vector<std::string> chunk_types(const std::string& png) {
  std::vector<std::string> types;
  for (std::size_t at = 8; at + 12 <= png.size();) {
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < 4; ++i)
      length = length << 8 | static_cast<unsigned char>(png[at + i]);
    types.push_back(png.substr(at + 4, 4));
    at += 12 + length;
  }
  return types;
}

}  // namespace penumbra::server::http
