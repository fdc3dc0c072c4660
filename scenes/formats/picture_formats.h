#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/image.h"

namespace penumbra::scenes {

/// Pictures in all formats that OpenImageIO knows and we use. It lives in a shared library of its
/// own, libpenumbra_formats.so, since OpenImageIO brings 260 more: 0.2 s at every start, which most
/// runs can do without (docs/decisions/0032-picture-formats.md). scenes/picture_io.h is the door.
class PictureFormats {
 public:
  virtual ~PictureFormats() = default;

  /// In the format of the extension, .jpg or .tif. JPEG has quality 95.
  virtual std::string encode(const std::string& extension, const Image8& picture) const = 0;
  /// EXR, a name per channel.
  virtual std::string encode_exr(const ImageF& picture,
                                 const std::vector<std::string>& channels) const = 0;

  /// As picture_io.h has it, of the extension's format.
  virtual Image8 decode(const std::string& extension, std::string_view bytes,
                        std::uint64_t most_bytes) const = 0;
  /// Turned as its EXIF says; .png, .jpg or .webp.
  virtual Image8 decode_upright(const std::string& extension, std::string_view bytes,
                                std::uint64_t most_bytes) const = 0;
  virtual ImageF decode_levels(const std::string& extension, std::string_view bytes,
                               bool& fractions) const = 0;
  virtual ImageF decode_exr(std::string_view bytes, std::vector<std::string>* channels) const = 0;

  virtual std::string version() const = 0;  ///< OpenImageIO's
};

/// Loads the library when first called: from the program's folder, from ../lib/penumbra beside it,
/// or from where it was built. Throws Error internal where it is in neither.
const PictureFormats& picture_formats();

}  // namespace penumbra::scenes
