#include "scenes/picture_io.h"

#include <algorithm>
#include <fstream>
#include <set>

#include "renderer/error.h"
#include "scenes/formats/limits.h"
#include "scenes/formats/picture_formats.h"
#include "scenes/formats/png.h"
#include "scenes/import/import.h"

namespace penumbra::scenes {
namespace {

constexpr std::uint64_t usual_bytes = std::uint64_t{1} << 29;

void write_file(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw bad_value("out", "cannot write " + file.string());
}

/// Extension of the format that the first bytes show; empty for anything else.
std::string known_format(std::string_view bytes) {
  if (bytes.substr(0, 8) == std::string_view("\x89PNG\r\n\x1a\n", 8)) return ".png";
  if (bytes.substr(0, 3) == std::string_view("\xff\xd8\xff", 3)) return ".jpg";
  if (bytes.substr(0, 4) == std::string_view("II*\0", 4) ||
      bytes.substr(0, 4) == std::string_view("MM\0*", 4))
    return ".tif";
  return {};
}

/// The same; throws unreadable for anything else.
std::string format_of(std::string_view bytes) {
  const std::string format = known_format(bytes);
  if (format.empty()) throw unreadable("the picture is neither PNG nor JPEG nor TIFF");
  return format;
}

/// Picture with exactly four channels: grey spreads over three, missing alpha is 255.
template <class T>
Image<T> as_rgba(Image<T> from) {
  if (from.channels == 4) return from;
  Image<T> to(from.width, from.height, 4, T{255});
  const bool grey = from.channels < 3;
  for (std::uint32_t y = 0; y < from.height; ++y)
    for (std::uint32_t x = 0; x < from.width; ++x) {
      for (std::uint32_t c = 0; c < 3; ++c) to.at(x, y, c) = from.at(x, y, grey ? 0 : c);
      if (from.channels == 2) to.at(x, y, 3) = from.at(x, y, 1);
    }
  return to;
}

}  // namespace

std::string encode_exr(const ImageF& picture, const std::vector<std::string>& channels) {
  check_encodable(picture);
  if (!channels.empty()) {
    const std::set<std::string> different(channels.begin(), channels.end());
    if (channels.size() != picture.channels || different.size() != channels.size() ||
        different.count("") != 0)
      throw bad_value("channels", "needs one name per channel, each different");
  }
  return picture_formats().encode_exr(picture, channels);
}

void write_picture(const std::filesystem::path& file, const Image8& picture) {
  check_encodable(picture);
  const std::string extension = lower_extension(file);
  if (extension == ".png") return write_file(file, encode_png(picture));
  if (extension == ".jpg" || extension == ".jpeg")
    return write_file(file, picture_formats().encode(".jpg", picture));
  if (extension == ".tif" || extension == ".tiff")
    return write_file(file, picture_formats().encode(".tif", picture));
  throw bad_value("out",
                  "'" + file.string() + "': a picture's name must end in .png, .jpg or .tif");
}

void write_picture(const std::filesystem::path& file, const ImageF& picture,
                   const std::vector<std::string>& channels) {
  if (lower_extension(file) != ".exr")
    throw bad_value("out", "'" + file.string() + "': a float picture's name must end in .exr");
  write_file(file, encode_exr(picture, channels));
}

Image8 decode_picture(std::string_view bytes, std::uint64_t most_bytes) {
  const std::string format = format_of(bytes);
  if (format == ".png")
    if (auto picture = decode_png(bytes, most_bytes)) return as_rgba(std::move(*picture));
  return as_rgba(picture_formats().decode(format, bytes, most_bytes));
}

Image8 decode_shown(std::string_view bytes, std::uint64_t most_bytes, std::uint8_t surround) {
  const bool webp =
      bytes.size() > 12 && bytes.substr(0, 4) == "RIFF" && bytes.substr(8, 4) == "WEBP";
  const std::string format = webp ? ".webp" : known_format(bytes);
  if (format.empty() || format == ".tif")
    throw unreadable("the picture is neither PNG nor JPEG nor WebP");
  Image8 picture = as_rgba(picture_formats().decode_upright(format, bytes, most_bytes));
  for (std::size_t i = 0; i < picture.pixels.size(); i += 4) {
    const int alpha = picture.pixels[i + 3];
    for (std::size_t c = i; c < i + 3; ++c)
      picture.pixels[c] = static_cast<std::uint8_t>(
          (picture.pixels[c] * alpha + surround * (255 - alpha) + 127) / 255);
    picture.pixels[i + 3] = 255;
  }
  return picture;
}

ImageF decode_levels(std::string_view bytes, bool& fractions) {
  const std::string format = format_of(bytes);
  if (format == ".png") {
    if (const auto whole = decode_png(bytes, usual_bytes)) {
      fractions = false;
      ImageF levels(whole->width, whole->height, whole->channels);
      std::copy(whole->pixels.begin(), whole->pixels.end(), levels.pixels.begin());
      return as_rgba(std::move(levels));
    }
  }
  return as_rgba(picture_formats().decode_levels(format, bytes, fractions));
}

Image8 read_picture(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  try {
    return decode_picture(bytes);
  } catch (const Error& error) {
    throw unreadable(file.string() + ": " + error.what(), "file");
  }
}

ImageF decode_exr(std::string_view bytes, std::vector<std::string>* channels) {
  if (bytes.substr(0, 4) != std::string_view("\x76\x2f\x31\x01", 4))
    throw unreadable("the picture is no EXR");
  return picture_formats().decode_exr(bytes, channels);
}

}  // namespace penumbra::scenes
