#pragma once

#include <string>

#include "renderer/error.h"
#include "renderer/image.h"

namespace penumbra::metrics {

inline std::string shape_text(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

/// What every comparison of encoded pictures demands. Throws bad_value with field "picture".
template <class T>
void check_pair(const Image<T>& picture, const Image<T>& reference) {
  for (const Image<T>* image : {&picture, &reference}) {
    if (image->channels != 3 && image->channels != 4)
      throw bad_value("picture", "pictures to compare must have 3 or 4 channels, not " +
                                     std::to_string(image->channels));
    if (image->empty() || image->pixels.size() != image->pixel_count() * image->channels)
      throw bad_value("picture", "a picture to compare is empty or incomplete");
  }
  if (picture.width != reference.width || picture.height != reference.height)
    throw bad_value("picture", "pictures to compare must have the same size, not " +
                                   shape_text(picture.width, picture.height) + " and " +
                                   shape_text(reference.width, reference.height));
}

/// Y = 0.299 R + 0.587 G + 0.114 B of an encoded pixel, in thousandths: exact in integers.
inline int luma_thousandths(const std::uint8_t* rgb) {
  return 299 * rgb[0] + 587 * rgb[1] + 114 * rgb[2];
}

/// Y in levels, 0..255.
inline double luma(const std::uint8_t* rgb) {
  return luma_thousandths(rgb) / 1000.0;
}
inline double luma(const float* rgb) {
  return 0.299 * static_cast<double>(rgb[0]) + 0.587 * static_cast<double>(rgb[1]) +
         0.114 * static_cast<double>(rgb[2]);
}

}  // namespace penumbra::metrics
