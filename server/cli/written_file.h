#pragma once

#include <filesystem>
#include <string_view>

namespace penumbra::server::cli {

/// Writes a file that a command was asked for. Throws Error `unwritable`.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace penumbra::server::cli
