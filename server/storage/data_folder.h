#pragma once

#include <filesystem>
#include <string>

namespace penumbra::server::storage {

/// The folder that one process owns: database, secrets, pictures and artefacts. The lock is the
/// kernel's (flock), so that a killed process leaves none behind.
class DataFolder {
 public:
  /// Creates the folder where it is missing (mode 0700). Throws Error `conflict` where another
  /// process holds it.
  explicit DataFolder(std::filesystem::path path);
  ~DataFolder();
  DataFolder(const DataFolder&) = delete;
  DataFolder& operator=(const DataFolder&) = delete;

  const std::filesystem::path& path() const { return root; }

 private:
  std::filesystem::path root;
  int lock = -1;
};

/// Writes a file whole or not at all: temporary name, sync, rename, sync of the folder.
void write_file_durably(const std::filesystem::path& file, const std::string& bytes,
                        unsigned mode = 0600);

/// Makes a folder that its owner alone may enter, whatever the umask. Throws Error `storage`.
void make_private_folder(const std::filesystem::path& folder);

/// A private folder that is removed with the object.
struct PassingFolder {
  explicit PassingFolder(std::filesystem::path path_) : path(std::move(path_)) {
    make_private_folder(path);
  }
  ~PassingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  PassingFolder(const PassingFolder&) = delete;
  PassingFolder& operator=(const PassingFolder&) = delete;
  std::filesystem::path path;
};

/// Removes what `write_file_durably` left half written when its process was killed.
void sweep_unfinished(const std::filesystem::path& folder);

/// Removes all that a killed server was making in a data folder: files that were half written,
/// uploads and exports.
void sweep_leftovers(const std::filesystem::path& data);

/// Bytes of a file. Throws Error `storage`.
std::string read_file(const std::filesystem::path& file);

}  // namespace penumbra::server::storage
