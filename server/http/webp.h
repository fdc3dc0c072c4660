#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace penumbra::server::http {

/// The pixels of a PNG of 8 bits as lossless WebP, and nothing but them. The same PNG makes the
/// same bytes. Empty for a picture wider or higher than 16383 pixels, which the format cannot hold.
/// Throws Error unreadable for what is no PNG.
std::optional<std::string> lossless_webp(std::string_view png);

/// Whether a header `Accept` names image/webp and does not refuse it with q=0 (RFC 9110, 12.5.1).
/// `image/*` and `*/*` do not count: programs send them that read no WebP.
bool takes_webp(std::string_view accept);

}  // namespace penumbra::server::http
