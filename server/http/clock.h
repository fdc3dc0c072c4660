#pragma once

#include <string>

namespace penumbra::server::http {

/// UTC now, or `seconds` later, as 2026-01-31T23:59:59.123Z: text order is time order.
std::string utc_now(double seconds = 0.0);

/// `seconds` after a time that utc_now returned.
std::string utc_later(const std::string& time, double seconds);

}  // namespace penumbra::server::http
