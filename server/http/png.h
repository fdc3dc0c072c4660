#pragma once

#include <string>
#include <string_view>

namespace penumbra::server::http {

/// The same PNG with nothing but its pixels: only the chunks IHDR, PLTE, tRNS, IDAT and IEND stay,
/// so that no text, time or tool tells pictures apart. Throws Error unreadable for anything that is
/// no PNG (W3C PNG, 5.3).
std::string pixels_only(std::string_view png);

}  // namespace penumbra::server::http
