#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/image.h"

namespace penumbra::scenes {

/// Pictures as files and as bytes. Encoded bytes depend on the pixels alone: no text, no time.

/// PNG of 1 to 4 channels, 8 bits, sRGB-encoded, packed for speed: every row as differences to the
/// left, runs alone. Four channels without a transparent pixel are written as three.
std::string encode_png(const Image8& picture);

/// EXR of 32-bit float channels. Names are R, G, B, A (or Y) where none are given; otherwise one
/// per channel, each different. Channels come back in the picture's order.
std::string encode_exr(const ImageF& picture, const std::vector<std::string>& channels = {});

/// By the file's extension: .png, .jpg (quality 95, alpha dropped) or .tif.
/// Throws bad_value (field "out") for another extension or where the file cannot be written.
void write_picture(const std::filesystem::path& file, const Image8& picture);

/// .exr, channels as encode_exr.
void write_picture(const std::filesystem::path& file, const ImageF& picture,
                   const std::vector<std::string>& channels = {});

/// PNG, JPEG or TIFF, told by its first bytes, as RGBA. Throws unreadable, before anything is
/// allocated also for more than 4 channels, 16384 pixels along a side, 2^27 pixels in all or
/// `most_bytes` bytes of result.
Image8 decode_picture(std::string_view bytes, std::uint64_t most_bytes = std::uint64_t{1} << 29);

/// PNG, JPEG or WebP as a browser shows it: turned as its EXIF says, 4 channels, 8 bits. What is
/// transparent lies over `surround`, so that every pixel is opaque. Limits as decode_picture.
Image8 decode_shown(std::string_view bytes, std::uint64_t most_bytes, std::uint8_t surround);

/// As decode_picture; throws not_found where there is no such file, unreadable naming the file.
Image8 read_picture(const std::filesystem::path& file);

/// As decode_picture in levels 0..255, RGBA; those of files with more than 8 bits have fractions.
ImageF decode_levels(std::string_view bytes, bool& fractions);

/// EXR written by encode_exr; `channels`, where given, receives the names.
ImageF decode_exr(std::string_view bytes, std::vector<std::string>* channels = nullptr);

}  // namespace penumbra::scenes
