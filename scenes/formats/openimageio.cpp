// libpenumbra_formats.so: what is not PNG of 8 bits.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <sstream>

#include "renderer/error.h"
#include "scenes/formats/limits.h"
#include "scenes/formats/picture_formats.h"

namespace penumbra::scenes {
namespace {

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// Writes into memory, in the format of `name`'s extension.
std::string encoded(const std::string& name, ImageSpec& spec, TypeDesc type, const void* pixels) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  OIIO::Filesystem::IOProxy* proxy = &memory;
  spec.attribute("oiio:ioproxy", TypeDesc::PTR, &proxy);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const auto output = ImageOutput::create(name);
  if (!output || !output->open(name, spec) || !output->write_image(type, pixels) ||
      !output->close())
    throw bad_value("picture", "cannot encode " + name + ": " +
                                   (output ? output->geterror() : OIIO::geterror()));
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

struct OpenedInput {
  // The reader refers to the memory behind it, so both live and die together.
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  std::unique_ptr<ImageInput> input;
};

/// Opens a picture that check_decodable lets pass; EXR may have more channels.
OpenedInput opened(const std::string& extension, std::string_view bytes, std::uint64_t most_bytes) {
  OpenedInput opened;
  opened.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<char*>(bytes.data()),
                                                                  bytes.size());
  OIIO::Filesystem::IOProxy* proxy = opened.memory.get();
  ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  config.attribute("oiio:ioproxy", TypeDesc::PTR, &proxy);
  opened.input = ImageInput::open("picture" + extension, &config);
  if (!opened.input) throw unreadable("the picture cannot be read: " + OIIO::geterror());
  const ImageSpec& spec = opened.input->spec();
  const auto size = [](int value) { return static_cast<std::uint64_t>(std::max(value, 0)); };
  if (spec.nchannels > 1024) throw unreadable("the picture has no pixels");
  const bool any_channels = extension == ".exr";
  check_decodable(size(spec.width), size(spec.height),
                  std::min<std::uint64_t>(size(spec.nchannels), any_channels ? 4 : 1024),
                  most_bytes);
  return opened;
}

template <class T>
Image<T> read_pixels(const OpenedInput& opened, TypeDesc type) {
  const ImageSpec& spec = opened.input->spec();
  Image<T> picture(static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height),
                   static_cast<std::uint32_t>(spec.nchannels));
  if (!opened.input->read_image(0, 0, 0, -1, type, picture.pixels.data()))
    throw unreadable("the picture is damaged: " + opened.input->geterror());
  return picture;
}

/// The pixels as they are to be looked at: `orientation` is EXIF's, 1 to 8.
Image8 turned(Image8& picture, int orientation) {
  const ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height),
                       static_cast<int>(picture.channels), TypeDesc::UINT8);
  OIIO::ImageBuf stored(spec, picture.pixels.data());
  stored.set_orientation(orientation);
  const OIIO::ImageBuf upright = OIIO::ImageBufAlgo::reorient(stored);
  Image8 result(static_cast<std::uint32_t>(upright.spec().width),
                static_cast<std::uint32_t>(upright.spec().height), picture.channels);
  if (!upright.get_pixels(upright.roi(), TypeDesc::UINT8, result.pixels.data()))
    throw unreadable("the picture cannot be turned: " + upright.geterror());
  return result;
}

class Formats : public PictureFormats {
 public:
  std::string encode(const std::string& extension, const Image8& picture) const override {
    ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height),
                   static_cast<int>(picture.channels), TypeDesc::UINT8);
    if (extension == ".jpg")
      spec.attribute("Compression", "jpeg:95");
    else
      spec.attribute("compression", "zip");
    return encoded("picture" + extension, spec, TypeDesc::UINT8, picture.pixels.data());
  }

  std::string encode_exr(const ImageF& picture,
                         const std::vector<std::string>& channels) const override {
    ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height),
                   static_cast<int>(picture.channels), TypeDesc::FLOAT);
    if (!channels.empty())
      spec.channelnames = channels;
    else if (picture.channels == 1)
      spec.channelnames = {"Y"};
    // The format sorts channels by name; this list restores the picture's order.
    std::string order;
    for (const std::string& name : spec.channelnames) order += name + "\n";
    spec.attribute("penumbra_channels", order);
    spec.attribute("DateTime", "1970:01:01 00:00:00");  // otherwise the time of writing
    spec.attribute("compression", "zip");
    return encoded("picture.exr", spec, TypeDesc::FLOAT, picture.pixels.data());
  }

  Image8 decode(const std::string& extension, std::string_view bytes,
                std::uint64_t most_bytes) const override {
    return read_pixels<std::uint8_t>(opened(extension, bytes, most_bytes), TypeDesc::UINT8);
  }

  Image8 decode_upright(const std::string& extension, std::string_view bytes,
                        std::uint64_t most_bytes) const override {
    const OpenedInput input = opened(extension, bytes, most_bytes);
    auto picture = read_pixels<std::uint8_t>(input, TypeDesc::UINT8);
    const int orientation = input.input->spec().get_int_attribute("Orientation", 1);
    return orientation > 1 && orientation <= 8 ? turned(picture, orientation) : picture;
  }

  ImageF decode_levels(const std::string& extension, std::string_view bytes,
                       bool& fractions) const override {
    const OpenedInput input = opened(extension, bytes, std::uint64_t{1} << 29);
    fractions = input.input->spec().format != TypeDesc::UINT8;
    if (fractions) {
      ImageF levels = read_pixels<float>(input, TypeDesc::FLOAT);
      for (float& value : levels.pixels) value *= 255.0f;
      return levels;
    }
    const auto whole = read_pixels<std::uint8_t>(input, TypeDesc::UINT8);
    ImageF levels(whole.width, whole.height, whole.channels);
    std::copy(whole.pixels.begin(), whole.pixels.end(), levels.pixels.begin());
    return levels;
  }

  ImageF decode_exr(std::string_view bytes, std::vector<std::string>* channels) const override {
    const OpenedInput input = opened(".exr", bytes, ~std::uint64_t{0});
    const ImageSpec& spec = input.input->spec();
    const ImageF stored = read_pixels<float>(input, TypeDesc::FLOAT);
    // Put the channels back into the order in which they were written.
    std::vector<std::string> names;
    std::istringstream order(std::string(spec.get_string_attribute("penumbra_channels")));
    for (std::string name; std::getline(order, name);) names.push_back(name);
    if (names.size() != stored.channels) names = spec.channelnames;
    ImageF picture(stored.width, stored.height, stored.channels);
    for (std::uint32_t c = 0; c < stored.channels; ++c) {
      const auto at = std::find(spec.channelnames.begin(), spec.channelnames.end(), names[c]);
      if (at == spec.channelnames.end()) throw unreadable("the picture lacks channel " + names[c]);
      const auto from = static_cast<std::size_t>(at - spec.channelnames.begin());
      for (std::size_t i = 0; i < stored.pixel_count(); ++i)
        picture.pixels[i * picture.channels + c] = stored.pixels[i * stored.channels + from];
    }
    if (channels != nullptr) *channels = names;
    return picture;
  }

  std::string version() const override { return OIIO_VERSION_STRING; }
};

}  // namespace
}  // namespace penumbra::scenes

extern "C" __attribute__((visibility("default"))) const penumbra::scenes::PictureFormats*
penumbra_picture_formats() {
  static const penumbra::scenes::Formats formats;
  return &formats;
}
