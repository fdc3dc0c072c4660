#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::server::storage {

/// Copies what a data folder keeps for good (database, key, journal, token, pictures, uploaded
/// scenes) into a new folder, while a server may be running on it. Returns what is damaged, as
/// verify_folder does. Throws Error not_found, `storage`.
std::vector<std::string> copy_folder(const std::filesystem::path& data,
                                     const std::filesystem::path& copy);

/// Writes such a copy into one zip file (mode 0600) with a manifest of SHA-256 digests. Throws
/// Error `storage` where the data folder is damaged: an earlier backup is worth more then.
void back_up(const std::filesystem::path& data, const std::filesystem::path& out);

/// Unpacks a backup into a folder that does not exist or is empty, and compares all digests. Throws
/// Error `conflict`, unreadable.
void restore(const std::filesystem::path& backup, const std::filesystem::path& data);

/// What is wrong with a data folder, a line each: structure, digests, journal, pictures,
/// permissions. Empty where it is sound. A server may be running on it.
std::vector<std::string> verify_folder(const std::filesystem::path& data);

}  // namespace penumbra::server::storage
