// PNG is read and written by libpng alone; OpenImageIO judges what it makes of the same bytes.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "scenes/picture_io.h"
#include "tests/scenes/gltf_file.h"

namespace penumbra::scenes {
namespace {

using test::error_of;
using testing::HasSubstr;

Image8 noise(std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
  Image8 picture(width, height, channels);
  std::uint32_t state = 1;
  for (auto& value : picture.pixels)
    value = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  return picture;
}

/// As OpenImageIO reads it, in the channels of the file.
Image8 judged(const std::string& bytes) {
  OIIO::Filesystem::IOMemReader memory(const_cast<char*>(bytes.data()), bytes.size());
  OIIO::Filesystem::IOProxy* proxy = &memory;
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  const auto input = OIIO::ImageInput::open("picture.png", &config);
  if (!input) throw std::runtime_error(OIIO::geterror());
  const auto& spec = input->spec();
  Image8 picture(static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height),
                 static_cast<std::uint32_t>(spec.nchannels));
  EXPECT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeDesc::UINT8, picture.pixels.data()));
  return picture;
}

/// Grey over three channels and alpha 255 where there is none.
Image8 spread(const Image8& from) {
  Image8 to(from.width, from.height, 4, 255);
  for (std::uint32_t y = 0; y < from.height; ++y)
    for (std::uint32_t x = 0; x < from.width; ++x) {
      for (std::uint32_t c = 0; c < 3; ++c)
        to.at(x, y, c) = from.at(x, y, from.channels < 3 ? 0 : c);
      if (from.channels % 2 == 0) to.at(x, y, 3) = from.at(x, y, from.channels - 1);
    }
  return to;
}

/// A PNG of 19 by 13 pixels as the standard allows it; samples are noise.
std::string png_of(int color_type, int bits, int interlace, bool transparent) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &bytes,
      [](png_structp writer, png_bytep data, std::size_t size) {
        static_cast<std::string*>(png_get_io_ptr(writer))
            ->append(reinterpret_cast<const char*>(data), size);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, 19, 13, bits, color_type, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  const int colors = 1 << std::min(bits, 8);
  std::vector<png_color> palette;
  std::vector<png_byte> alphas;
  for (int i = 0; i < colors; ++i) {
    const auto level = static_cast<png_byte>(i * 255 / (colors - 1));
    palette.push_back({level, static_cast<png_byte>(255 - level), 77});
    alphas.push_back(static_cast<png_byte>(255 - i));
  }
  if (color_type == PNG_COLOR_TYPE_PALETTE) {
    png_set_PLTE(png, info, palette.data(), colors);
    if (transparent) png_set_tRNS(png, info, alphas.data(), colors / 2, nullptr);
  } else if (transparent) {
    png_color_16 key{0, 1, 1, 1, 1};
    png_set_tRNS(png, info, nullptr, 0, &key);
  }
  const Image8 samples = noise(19 * 8, 13, 1);
  std::vector<png_bytep> rows;
  for (std::uint32_t y = 0; y < 13; ++y)
    rows.push_back(const_cast<png_bytep>(&samples.pixels[std::size_t{y} * samples.width]));
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

TEST(Png, IsWrittenSoThatOthersReadTheSame) {
  for (std::uint32_t channels = 1; channels <= 4; ++channels) {
    const Image8 picture = noise(67, 41, channels);
    const Image8 back = judged(encode_png(picture));
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(back.pixels, picture.pixels);
  }
}

TEST(Png, LeavesOutAnAlphaThatSaysNothing) {
  Image8 picture = noise(67, 41, 4);
  for (std::size_t i = 3; i < picture.pixels.size(); i += 4) picture.pixels[i] = 255;
  EXPECT_EQ(judged(encode_png(picture)).channels, 3u);
  EXPECT_EQ(decode_picture(encode_png(picture)).pixels, picture.pixels);
  picture.pixels.back() = 254;
  EXPECT_EQ(judged(encode_png(picture)).channels, 4u);
  EXPECT_THAT(error_of([] { encode_png(Image8(2, 2, 5)); }), HasSubstr("4 channels"));
}

TEST(Png, OfEveryKindIsReadAsOthersReadIt) {
  const std::vector<std::pair<int, std::vector<int>>> kinds{{PNG_COLOR_TYPE_GRAY, {1, 2, 4, 8, 16}},
                                                            {PNG_COLOR_TYPE_PALETTE, {1, 2, 4, 8}},
                                                            {PNG_COLOR_TYPE_RGB, {8, 16}},
                                                            {PNG_COLOR_TYPE_GRAY_ALPHA, {8, 16}},
                                                            {PNG_COLOR_TYPE_RGB_ALPHA, {8, 16}}};
  for (const auto& [color, depths] : kinds)
    for (const int bits : depths)
      for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7})
        for (const bool transparent : {false, true}) {
          if (transparent && (color & PNG_COLOR_MASK_ALPHA) != 0) continue;
          const std::string bytes = png_of(color, bits, interlace, transparent);
          EXPECT_EQ(decode_picture(bytes).pixels, spread(judged(bytes)).pixels)
              << "colour type " << color << ", " << bits << " bits, interlace " << interlace
              << ", transparent " << transparent;
        }
}

TEST(Png, CutAnywhereIsRefused) {
  const std::string bytes = encode_png(noise(9, 7, 3));
  for (std::size_t length = 8; length + 12 < bytes.size(); ++length)
    EXPECT_THAT(error_of([&] { decode_picture(bytes.substr(0, length)); }), HasSubstr("unreadable"))
        << length;
  std::string wrong = bytes;
  wrong[bytes.size() / 2] = static_cast<char>(wrong[bytes.size() / 2] + 1);
  EXPECT_THAT(error_of([&] { decode_picture(wrong); }), HasSubstr("damaged"));
}

}  // namespace
}  // namespace penumbra::scenes
