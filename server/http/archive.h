#pragma once

#include <string>
#include <utility>
#include <vector>

namespace penumbra::server::http {

/// A zip archive of named texts. Throws Error `internal` where it cannot be made.
std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace penumbra::server::http
