#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace penumbra::server::http {

/// The same PNG with nothing but its pixels: only the chunks IHDR, PLTE, tRNS, IDAT and IEND stay,
/// so that no text, time or tool tells pictures apart. Throws Error unreadable for anything that is
/// no PNG (W3C PNG, 5.3).
std::string pixels_only(std::string_view png);

/// Width and height in pixels. Throws as pixels_only.
std::pair<std::uint32_t, std::uint32_t> size_of_png(std::string_view png);

/// As pixels_only, with the pixels' bytes packed as tightly as deflate can (level 9): renders are
/// packed for speed, but a study's pictures are packed once and sent to many. Equal pixels with
/// equal filters make equal bytes.
std::string packed_tightly(std::string_view png);

}  // namespace penumbra::server::http
