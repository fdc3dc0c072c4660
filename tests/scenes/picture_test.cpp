#include "scenes/picture_io.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <ctime>
#include <fstream>
#include <sstream>

#include "scenes/generators/textures.h"
#include "tests/scenes/gltf_file.h"

namespace penumbra::scenes {
namespace {

using test::error_of;
using test::TemporaryFolder;
using testing::HasSubstr;

Image8 gradient(std::uint32_t channels) {
  Image8 picture(37, 23, channels);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    picture.pixels[i] = static_cast<std::uint8_t>(i * 7 % 251);
  return picture;
}

TEST(Pictures, ComeBackFromPngAsTheyWere) {
  const Image8 picture = gradient(4);
  const Image8 back = decode_picture(encode_png(picture));
  EXPECT_EQ(back.pixels, picture.pixels);
  const Image8 opaque = decode_picture(encode_png(gradient(3)));
  ASSERT_EQ(opaque.channels, 4u);
  EXPECT_EQ(opaque.at(5, 6, 1), gradient(3).at(5, 6, 1));
  EXPECT_EQ(opaque.at(5, 6, 3), 255);
}

TEST(Pictures, PngHoldsPixelsAndNothingThatTellsItsOrigin) {
  const std::string bytes = encode_png(gradient(4));
  EXPECT_EQ(bytes, encode_png(gradient(4)));
  std::vector<std::string> chunks;
  for (std::size_t at = 8; at + 8 <= bytes.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[at + i]); };
    const std::size_t length = std::size_t{byte(0)} << 24 | byte(1) << 16 | byte(2) << 8 | byte(3);
    chunks.push_back(bytes.substr(at + 4, 4));
    at += 12 + length;
  }
  for (const std::string& chunk : chunks)
    EXPECT_THAT(chunk, testing::AnyOf("IHDR", "IDAT", "IEND", "gAMA", "sRGB", "pHYs", "oFFs"))
        << chunk;
}

TEST(Pictures, ExrKeepsFloatsAndTheOrderOfItsChannels) {
  ImageF picture(5, 4, 3);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    picture.pixels[i] = 1.0f / static_cast<float>(i + 1);
  std::vector<std::string> names;
  // Sorted by name the channels would come back as green, lamp, zenith.
  const ImageF back = decode_exr(encode_exr(picture, {"zenith", "lamp", "green"}), &names);
  EXPECT_EQ(back.pixels, picture.pixels);
  EXPECT_EQ(names, (std::vector<std::string>{"zenith", "lamp", "green"}));
  EXPECT_EQ(encode_exr(picture), encode_exr(picture));
  std::time_t now = std::time(nullptr);
  char year[8];
  std::strftime(year, sizeof year, "%Y:", std::gmtime(&now));
  EXPECT_THAT(encode_exr(picture), testing::Not(HasSubstr(year))) << "bytes depend on pixels alone";
  EXPECT_THAT(error_of([&] { encode_exr(picture, {"a", "a", "b"}); }), HasSubstr("each different"));
}

TEST(Pictures, AreWrittenInTheFormatOfTheirName) {
  const TemporaryFolder folder;
  Image8 flat(16, 16, 4, 200);
  for (const char* name : {"a.png", "a.jpg", "a.tif", "A.PNG"}) {
    write_picture(folder.path / name, flat);
    const Image8 back = read_picture(folder.path / name);
    EXPECT_EQ(back.width, 16u);
    EXPECT_NEAR(back.at(3, 3, 1), 200, 2) << name;
    const auto input = OIIO::ImageInput::open((folder.path / name).string());
    ASSERT_TRUE(input) << name;
  }
  write_picture(folder.path / "a.exr", ImageF(4, 4, 3, 0.5f));
  EXPECT_EQ(OIIO::ImageInput::open((folder.path / "a.exr").string())->spec().nchannels, 3);
  EXPECT_THAT(error_of([&] { write_picture(folder.path / "a.bmp", flat); }),
              HasSubstr(".png, .jpg or .tif"));
  EXPECT_THAT(error_of([&] { write_picture(folder.path / "none" / "a.png", flat); }),
              HasSubstr("cannot write"));
}

TEST(Pictures, DamagedOnesAreRefused) {
  const std::string bytes = encode_png(gradient(4));
  EXPECT_THAT(error_of([&] { decode_picture(bytes.substr(0, bytes.size() / 2)); }),
              HasSubstr("unreadable"));
  EXPECT_THAT(error_of([&] { decode_picture("P6 1 1 255 abc"); }),
              HasSubstr("neither PNG nor JPEG"));
  EXPECT_THAT(error_of([&] { decode_picture(encode_exr(ImageF(2, 2, 3))); }),
              HasSubstr("neither PNG nor JPEG"))
      << "EXR is written and never read from outside";
  EXPECT_THAT(error_of([] { read_picture("/nowhere/at/all.png"); }), HasSubstr("not_found"));
}

TEST(Textures, TileWithoutSeams) {
  // Across the border neighbours differ no more than they do inside, on average over the border.
  for (const std::string& name : texture_generators()) {
    const Texture texture = generate_texture(name, 128, 1);
    const auto step = [&](std::uint32_t x0, std::uint32_t x1, bool down) {
      double sum = 0.0;
      for (std::uint32_t i = 0; i < 128; ++i) {
        const std::size_t a =
            down ? (std::size_t{x0} * 128 + i) * 4 : (std::size_t{i} * 128 + x0) * 4;
        const std::size_t b =
            down ? (std::size_t{x1} * 128 + i) * 4 : (std::size_t{i} * 128 + x1) * 4;
        sum += std::abs(static_cast<double>(texture.rgba[a + 1]) - texture.rgba[b + 1]);
      }
      return sum / 128.0;
    };
    for (const bool down : {false, true}) {
      double most = 0.0;
      for (std::uint32_t x = 0; x + 1 < 128; ++x) most = std::max(most, step(x, x + 1, down));
      EXPECT_LE(step(127, 0, down), most + 2.0) << name << (down ? " down" : " across");
    }
  }
}

TEST(Textures, AreSeededAndNamedWhenUnknown) {
  EXPECT_EQ(generate_texture("wood", 64, 1).rgba, generate_texture("wood", 64, 1).rgba);
  EXPECT_NE(generate_texture("wood", 64, 1).rgba, generate_texture("wood", 64, 2).rgba);
  EXPECT_THAT(error_of([] { generate_texture("velvet", 64, 1); }), HasSubstr("painted_metal"));
}

}  // namespace
}  // namespace penumbra::scenes
