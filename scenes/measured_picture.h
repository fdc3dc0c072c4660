#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/image.h"

namespace penumbra::scenes {

/// What measures compare: red, green and blue as sRGB-encoded levels 0..255, with fractions where
/// the file has more than 8 bits.
struct MeasuredPicture {
  ImageF levels;
  std::vector<std::string> notes;  ///< what was done to get there: alpha left out, light encoded
};

/// PNG, JPEG or TIFF of 8 or 16 bits, or EXR in linear light, which is encoded. Throws as
/// read_picture, and unreadable for values that are not finite.
MeasuredPicture read_measured_picture(const std::filesystem::path& file);

}  // namespace penumbra::scenes
