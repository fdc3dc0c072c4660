#include "scenes/picture_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>

#include "renderer/error.h"
#include "scenes/import/import.h"

namespace penumbra::scenes {
namespace {

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

constexpr std::uint32_t max_side = 16384;
constexpr std::uint64_t max_pixels = std::uint64_t{1} << 27;

template <class T>
void check_shape(const Image<T>& picture) {
  if (picture.width == 0 || picture.height == 0 || picture.channels == 0 ||
      picture.pixels.size() != picture.pixel_count() * picture.channels)
    throw bad_value("picture", "a picture without pixels cannot be written");
}

/// Writes through OpenImageIO into memory, in the format that `name`'s extension stands for.
std::string encode(const std::string& name, ImageSpec& spec, TypeDesc type, const void* pixels) {
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

ImageSpec spec_of(const Image8& picture) {
  return {static_cast<int>(picture.width), static_cast<int>(picture.height),
          static_cast<int>(picture.channels), TypeDesc::UINT8};
}

void write_file(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw bad_value("out", "cannot write " + file.string());
}

/// Extension that stands for what the first bytes say; empty for anything else.
std::string format_of(std::string_view bytes) {
  if (bytes.substr(0, 8) == std::string_view("\x89PNG\r\n\x1a\n", 8)) return ".png";
  if (bytes.substr(0, 3) == std::string_view("\xff\xd8\xff", 3)) return ".jpg";
  if (bytes.substr(0, 4) == std::string_view("II*\0", 4) ||
      bytes.substr(0, 4) == std::string_view("MM\0*", 4))
    return ".tif";
  return {};
}

struct OpenedInput {
  // The reader refers to the memory behind it, so both live and die together.
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  std::unique_ptr<ImageInput> input;
};

OpenedInput open_memory(const std::string& extension, std::string_view bytes) {
  OpenedInput opened;
  opened.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<char*>(bytes.data()),
                                                                  bytes.size());
  OIIO::Filesystem::IOProxy* proxy = opened.memory.get();
  ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  config.attribute("oiio:ioproxy", TypeDesc::PTR, &proxy);
  const std::string name = "picture" + extension;
  opened.input = ImageInput::open(name, &config);
  if (!opened.input) throw unreadable("the picture cannot be read: " + OIIO::geterror());
  const ImageSpec& spec = opened.input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 || spec.nchannels > 1024)
    throw unreadable("the picture has no pixels");
  const auto pixels =
      static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
  if (spec.width > static_cast<int>(max_side) || spec.height > static_cast<int>(max_side) ||
      pixels > max_pixels)
    throw unreadable("the picture is too large: " + std::to_string(spec.width) + " by " +
                     std::to_string(spec.height) + " pixels");
  return opened;
}

/// Picture with exactly four channels: grey spreads over three, missing alpha is 255.
template <class T>
Image<T> as_rgba(const Image<T>& from) {
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

std::string encode_png(const Image8& picture) {
  check_shape(picture);
  ImageSpec spec = spec_of(picture);
  spec.attribute("png:compressionLevel", 3);
  return encode("picture.png", spec, TypeDesc::UINT8, picture.pixels.data());
}

std::string encode_exr(const ImageF& picture, const std::vector<std::string>& channels) {
  check_shape(picture);
  ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height),
                 static_cast<int>(picture.channels), TypeDesc::FLOAT);
  if (!channels.empty()) {
    const std::set<std::string> different(channels.begin(), channels.end());
    if (channels.size() != picture.channels || different.size() != channels.size() ||
        different.count("") != 0)
      throw bad_value("channels", "needs one name per channel, each different");
    spec.channelnames = channels;
  } else if (picture.channels == 1) {
    spec.channelnames = {"Y"};
  }
  // The format sorts channels by name; this list restores the picture's order.
  std::string order;
  for (const std::string& name : spec.channelnames) order += name + "\n";
  spec.attribute("penumbra_channels", order);
  spec.attribute("compression", "zip");
  return encode("picture.exr", spec, TypeDesc::FLOAT, picture.pixels.data());
}

void write_picture(const std::filesystem::path& file, const Image8& picture) {
  const std::string extension = lower_extension(file);
  if (extension == ".png") return write_file(file, encode_png(picture));
  check_shape(picture);
  ImageSpec spec = spec_of(picture);
  if (extension == ".jpg" || extension == ".jpeg") {
    spec.attribute("Compression", "jpeg:95");
    return write_file(file, encode("picture.jpg", spec, TypeDesc::UINT8, picture.pixels.data()));
  }
  if (extension == ".tif" || extension == ".tiff") {
    spec.attribute("compression", "zip");
    return write_file(file, encode("picture.tif", spec, TypeDesc::UINT8, picture.pixels.data()));
  }
  throw bad_value("out",
                  "'" + file.string() + "': a picture's name must end in .png, .jpg or .tif");
}

void write_picture(const std::filesystem::path& file, const ImageF& picture,
                   const std::vector<std::string>& channels) {
  if (lower_extension(file) != ".exr")
    throw bad_value("out", "'" + file.string() + "': a float picture's name must end in .exr");
  write_file(file, encode_exr(picture, channels));
}

namespace {

/// A picture that may be decoded; see decode_picture.
OpenedInput open_picture(std::string_view bytes, std::uint64_t most_bytes) {
  const std::string extension = format_of(bytes);
  if (extension.empty()) throw unreadable("the picture is neither PNG nor JPEG nor TIFF");
  OpenedInput opened = open_memory(extension, bytes);
  const ImageSpec& spec = opened.input->spec();
  if (spec.nchannels > 4)
    throw unreadable("the picture has " + std::to_string(spec.nchannels) +
                     " channels, more than red, green, blue and alpha");
  const std::uint64_t needed =
      4 * static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height);
  if (needed > most_bytes)
    throw unreadable("the picture of " + std::to_string(spec.width) + " by " +
                     std::to_string(spec.height) + " pixels takes more than the " +
                     std::to_string(most_bytes >> 20) + " MiB that are left for pictures");
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

}  // namespace

Image8 decode_picture(std::string_view bytes, std::uint64_t most_bytes) {
  return as_rgba(read_pixels<std::uint8_t>(open_picture(bytes, most_bytes), TypeDesc::UINT8));
}

ImageF decode_levels(std::string_view bytes, bool& fractions) {
  const OpenedInput opened = open_picture(bytes, std::uint64_t{1} << 29);
  fractions = opened.input->spec().format != TypeDesc::UINT8;
  if (!fractions) {
    const Image8 whole = as_rgba(read_pixels<std::uint8_t>(opened, TypeDesc::UINT8));
    ImageF levels(whole.width, whole.height, 4);
    std::copy(whole.pixels.begin(), whole.pixels.end(), levels.pixels.begin());
    return levels;
  }
  ImageF levels = read_pixels<float>(opened, TypeDesc::FLOAT);
  for (float& value : levels.pixels) value *= 255.0f;
  return as_rgba(levels);
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
  const OpenedInput opened = open_memory(".exr", bytes);
  const ImageSpec& spec = opened.input->spec();
  ImageF stored(static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height),
                static_cast<std::uint32_t>(spec.nchannels));
  if (!opened.input->read_image(0, 0, 0, -1, TypeDesc::FLOAT, stored.pixels.data()))
    throw unreadable("the picture is damaged: " + opened.input->geterror());
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

}  // namespace penumbra::scenes
