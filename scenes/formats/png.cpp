#include "scenes/formats/png.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

#include "renderer/error.h"
#include "scenes/formats/limits.h"
#include "scenes/picture_io.h"

namespace penumbra::scenes {
namespace {

/// What libpng says before it jumps out.
struct Complaint {
  std::string text;
};

[[noreturn]] void complain(png_structp png, png_const_charp text) {
  static_cast<Complaint*>(png_get_error_ptr(png))->text = text;
  png_longjmp(png, 1);
}

void say_nothing(png_structp, png_const_charp) {}

void append_bytes(png_structp png, png_bytep bytes, std::size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))
      ->append(reinterpret_cast<const char*>(bytes), size);
}

void no_flush(png_structp) {}

void take(png_structp png, png_bytep bytes, std::size_t size) {
  auto& left = *static_cast<std::string_view*>(png_get_io_ptr(png));
  if (size > left.size()) png_error(png, "the file ends too early");
  std::memcpy(bytes, left.data(), size);
  left.remove_prefix(size);
}

int color_type(std::uint32_t channels) {
  constexpr int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                           PNG_COLOR_TYPE_RGB_ALPHA};
  return types[channels - 1];
}

bool is_opaque(const Image8& picture) {
  for (std::size_t i = 3; i < picture.pixels.size(); i += 4)
    if (picture.pixels[i] != 255) return false;
  return true;
}

Image8 without_alpha(const Image8& picture) {
  Image8 result(picture.width, picture.height, 3);
  for (std::size_t i = 0; i < picture.pixel_count(); ++i)
    std::copy_n(&picture.pixels[4 * i], 3, &result.pixels[3 * i]);
  return result;
}

/// The rows of a picture, of which libpng wants pointers.
std::vector<png_bytep> rows_of(const Image8& picture) {
  std::vector<png_bytep> rows(picture.height);
  for (std::uint32_t y = 0; y < picture.height; ++y)
    rows[y] = const_cast<png_bytep>(picture.pixels.data()) +
              std::size_t{y} * picture.width * picture.channels;
  return rows;
}

// libpng jumps back to setjmp when it fails: functions that call it so hold nothing that would have
// to be destroyed.

bool write_all(png_structp png, png_infop info, const Image8& picture, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_compression_level(png, 1);
  png_set_compression_strategy(png, 3);  // Z_RLE
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, info, picture.width, picture.height, 8, color_type(picture.channels),
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  png_write_image(png, rows);
  png_write_end(png, nullptr);
  return true;
}

bool read_head(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_info(png, info);
  return true;
}

/// Asks for 8 bits and full colours.
bool prepare_reading(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_expand(png);  // palettes, fewer bits and the colour that means transparency
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  return true;
}

bool read_rows(png_structp png, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_image(png, rows);
  return true;
}

struct Writer {
  Complaint complaint;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &complaint, complain, say_nothing);
  png_infop info = png_create_info_struct(png);
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

struct Reader {
  Complaint complaint;
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &complaint, complain, say_nothing);
  png_infop info = png_create_info_struct(png);
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }

  void require(bool done) const {
    if (!done) throw unreadable("the picture is damaged: " + complaint.text);
  }
};

}  // namespace

std::string encode_png(const Image8& picture) {
  check_encodable(picture);
  if (picture.channels > 4) throw bad_value("picture", "a PNG has at most 4 channels");
  if (picture.channels == 4 && is_opaque(picture)) return encode_png(without_alpha(picture));
  std::string bytes;
  Writer writer;
  png_set_write_fn(writer.png, &bytes, append_bytes, no_flush);
  auto rows = rows_of(picture);
  if (!write_all(writer.png, writer.info, picture, rows.data()))
    throw bad_value("picture", "cannot encode a PNG: " + writer.complaint.text);
  return bytes;
}

std::optional<Image8> decode_png(std::string_view bytes, std::uint64_t most_bytes) {
  Reader reader;
  png_set_read_fn(reader.png, &bytes, take);
  png_set_user_limits(reader.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // checked below, in words
  reader.require(read_head(reader.png, reader.info));
  if (png_get_bit_depth(reader.png, reader.info) == 16) return std::nullopt;
  const auto width = png_get_image_width(reader.png, reader.info);
  const auto height = png_get_image_height(reader.png, reader.info);
  check_decodable(width, height, png_get_channels(reader.png, reader.info), most_bytes);
  reader.require(prepare_reading(reader.png, reader.info));
  Image8 picture(width, height, png_get_channels(reader.png, reader.info));
  auto rows = rows_of(picture);
  reader.require(read_rows(reader.png, rows.data()));
  return picture;
}

}  // namespace penumbra::scenes
