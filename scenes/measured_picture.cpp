#include "scenes/measured_picture.h"

#include <algorithm>
#include <cmath>

#include "renderer/error.h"
#include "scenes/import/import.h"
#include "scenes/picture_io.h"

namespace penumbra::scenes {
namespace {

/// sRGB (IEC 61966-2-1) as a level 0..255.
float level_of(float linear) {
  const double v = std::clamp(static_cast<double>(linear), 0.0, 1.0);
  return static_cast<float>(255.0 *
                            (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055));
}

/// Where a channel of that name is; `otherwise` where none is.
std::uint32_t channel(const std::vector<std::string>& names, const char* name,
                      std::uint32_t otherwise) {
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? otherwise : static_cast<std::uint32_t>(at - names.begin());
}

MeasuredPicture from_exr(const std::string& bytes) {
  std::vector<std::string> names;
  const ImageF linear = decode_exr(bytes, &names);
  const std::uint32_t last = linear.channels - 1;
  const std::uint32_t from[3] = {channel(names, "R", 0), channel(names, "G", std::min(1u, last)),
                                 channel(names, "B", std::min(2u, last))};
  MeasuredPicture picture;
  picture.levels = ImageF(linear.width, linear.height, 3);
  bool clipped = false;
  for (std::uint32_t y = 0; y < linear.height; ++y)
    for (std::uint32_t x = 0; x < linear.width; ++x)
      for (std::uint32_t c = 0; c < 3; ++c) {
        const float value = linear.at(x, y, from[c]);
        if (!std::isfinite(value)) throw unreadable("the picture has values that are not finite");
        clipped = clipped || value < 0.0f || value > 1.0f;
        picture.levels.at(x, y, c) = level_of(value);
      }
  picture.notes.push_back("is in linear light: it was encoded as sRGB");
  if (clipped) picture.notes.push_back("has light outside 0..1, which was clipped");
  return picture;
}

MeasuredPicture from_levels(const std::string& bytes) {
  MeasuredPicture picture;
  bool fractions = false;
  const ImageF rgba = decode_levels(bytes, fractions);
  picture.levels = ImageF(rgba.width, rgba.height, 3);
  std::size_t open = 0;
  for (std::size_t i = 0; i < rgba.pixel_count(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) picture.levels.pixels[3 * i + c] = rgba.pixels[4 * i + c];
    open += rgba.pixels[4 * i + 3] < 255.0f;
  }
  if (fractions) picture.notes.push_back("has more than 8 bits a channel, and all of them count");
  if (open > 0)
    picture.notes.push_back("has " + std::to_string(open) +
                            " pixels that are not opaque: alpha is left out, their colours count");
  return picture;
}

}  // namespace

MeasuredPicture read_measured_picture(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  try {
    return bytes.starts_with("\x76\x2f\x31\x01") ? from_exr(bytes) : from_levels(bytes);
  } catch (const Error& error) {
    throw unreadable(file.string() + ": " + error.what(), "file");
  }
}

}  // namespace penumbra::scenes
