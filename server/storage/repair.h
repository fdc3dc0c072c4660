#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::server::storage {

/// What a repair did.
struct Repair {
  std::vector<std::string> found;     ///< what verify_folder said before
  std::vector<std::string> aside;     ///< rows that were moved aside or are gone, a line each
  std::size_t kept = 0;               ///< rows of the new database
  std::vector<std::string> pictures;  ///< digests of those that are to be drawn again
  std::filesystem::path folder;       ///< what was moved aside; empty where nothing was wrong
};

/// Makes a damaged data folder sound, as far as that can be: a new database takes every row whose
/// digest fits and that the journal knows; the others go into rows.jsonl in a new folder
/// damaged-TIME, beside a copy of database, log, journal and key as they were. Nothing is deleted.
/// Altered pictures are moved there too; what is to be drawn again is for the caller. Throws Error
/// `conflict` where a server runs on it, `storage` where nothing of the database can be read.
Repair repair_folder(const std::filesystem::path& data);

}  // namespace penumbra::server::storage
