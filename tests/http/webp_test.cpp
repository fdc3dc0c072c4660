// What participants' browsers get: the same pixels in fewer bytes.
#include "server/http/webp.h"

#include <gtest/gtest.h>
#include <webp/decode.h>

#include <random>

#include "renderer/error.h"
#include "scenes/picture_io.h"
#include "server/http/png.h"
#include "tests/http/png_files.h"

namespace penumbra::server::http {
namespace {

/// A gradient with noise in its right half; alpha falls to zero where asked for.
Image8 some_picture(bool transparent) {
  Image8 picture(61, 37, 4);
  std::mt19937 random(7);
  for (std::uint32_t y = 0; y < picture.height; ++y)
    for (std::uint32_t x = 0; x < picture.width; ++x) {
      for (std::uint32_t c = 0; c < 3; ++c)
        picture.at(x, y, c) =
            static_cast<std::uint8_t>(x > 30 ? random() & 255u : 3 * x + y + 20 * c);
      picture.at(x, y, 3) = static_cast<std::uint8_t>(transparent ? 7 * y : 255);
    }
  return picture;
}

TEST(LosslessWebP, DecodesToThePixelsOfThePng) {
  for (const bool transparent : {false, true}) {
    const auto picture = some_picture(transparent);
    const auto webp = lossless_webp(scenes::encode_png(picture)).value();
    int width = 0;
    int height = 0;
    std::uint8_t* pixels = WebPDecodeRGBA(reinterpret_cast<const std::uint8_t*>(webp.data()),
                                          webp.size(), &width, &height);
    ASSERT_NE(pixels, nullptr);
    ASSERT_EQ(width, 61);
    ASSERT_EQ(height, 37);
    EXPECT_EQ(std::vector<std::uint8_t>(pixels, pixels + 4 * 61 * 37), picture.pixels);
    WebPFree(pixels);
  }
}

TEST(LosslessWebP, HoldsNothingButPixels) {
  const auto webp = lossless_webp(grey_png(100, "secret technique")).value();
  EXPECT_EQ(webp, lossless_webp(grey_png(100, "another")));
  // One chunk that fills the file (WebP Container Specification): no EXIF, XMP or profile.
  ASSERT_EQ(webp.substr(0, 4) + webp.substr(8, 8), "RIFFWEBPVP8L");
  std::uint32_t length = 0;
  for (std::size_t i = 4; i > 0; --i)
    length = length << 8 | static_cast<unsigned char>(webp[15 + i]);
  EXPECT_EQ(webp.size(), 20 + length + length % 2);
}

/// 14 bits hold width and height less one (WebP Lossless Bitstream, 3), and libwebp takes one less.
TEST(LosslessWebP, IsLeftOutWhereTheFormatCannotHoldThePicture) {
  for (const auto& [width, height] : {std::pair{16384u, 1u}, {1u, 16384u}})
    EXPECT_FALSE(lossless_webp(scenes::encode_png(Image8(width, height, 4, 200))).has_value());
  const auto webp = lossless_webp(scenes::encode_png(Image8(16383, 1, 4, 200))).value();
  int width = 0;
  int height = 0;
  ASSERT_EQ(
      WebPGetInfo(reinterpret_cast<const std::uint8_t*>(webp.data()), webp.size(), &width, &height),
      1);
  EXPECT_EQ(width, 16383);
}

TEST(LosslessWebP, RefusesWhatIsNoPicture) {
  EXPECT_THROW(lossless_webp("no picture"), Error);
}

TEST(TakesWebP, WhenTheHeaderNamesItAndDoesNotRefuseIt) {
  for (const char* accept : {"image/webp", "image/avif,image/webp,*/*;q=0.8", "IMAGE/WEBP ; q=0.1",
                             "text/html, image/webp;q=1.0", "image/webp;q=0.001"})
    EXPECT_TRUE(takes_webp(accept)) << accept;
  for (const char* accept : {"", "*/*", "image/*", "image/png", "image/webp;q=0",
                             "image/webp; q=0.000", "image/webpx", "text/image/webp", ",;,=;q"})
    EXPECT_FALSE(takes_webp(accept)) << accept;
}

TEST(PackedTightly, HasTheSamePixelsInFewerBytesAndNothingElse) {
  const auto picture = some_picture(true);
  const auto fast = scenes::encode_png(picture);
  const auto tight = packed_tightly(fast);
  EXPECT_EQ(scenes::decode_picture(tight).pixels, picture.pixels);
  EXPECT_EQ(chunk_types(tight), (std::vector<std::string>{"IHDR", "IDAT", "IEND"}));
  EXPECT_LT(tight.size(), fast.size());
  // The stream's first bytes tell its level: 3 is the slowest (RFC 1950, FLEVEL).
  EXPECT_EQ(static_cast<unsigned char>(tight[tight.find("IDAT") + 5]) >> 6, 3);
  EXPECT_EQ(packed_tightly(grey_png(9, "one")), packed_tightly(grey_png(9, "another")));
}

TEST(PackedTightly, RefusesWhatIsCutShortOrDamaged) {
  const auto png = grey_png(100, "x");
  for (std::size_t length = 0; length < png.size(); ++length)
    EXPECT_THROW(packed_tightly(png.substr(0, length)), Error) << length;
  auto damaged = png;
  damaged[damaged.find("IDAT") + 5] ^= 1;
  EXPECT_THROW(packed_tightly(damaged), Error);
}

}  // namespace
}  // namespace penumbra::server::http
