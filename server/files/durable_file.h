#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace penumbra::server {

/// How a file is written.
struct Durably {
  unsigned mode = 0640;      ///< of a new file, less the umask
  bool sync_folder = false;  ///< its name, too, outlasts a loss of power
};

/// Writes `bytes` to `temporary`, syncs, and renames it to `path`: a reader sees the whole file or
/// none. Throws std::system_error; `temporary` is removed then.
void write_durably(const std::filesystem::path& path, const std::filesystem::path& temporary,
                   std::string_view bytes, const Durably& how = {});

/// The whole file, or nothing where it cannot be read.
std::optional<std::string> read_whole(const std::filesystem::path& path);

}  // namespace penumbra::server
