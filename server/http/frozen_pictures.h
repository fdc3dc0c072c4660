#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "server/jobs/render_service.h"
#include "server/storage/studies.h"

namespace penumbra::server::http {

/// The pictures that studies were opened with: files named by their SHA-256. A picture is compared
/// with its name each time it is read, since a stimulus that changed must never be shown. One that
/// is gone or altered is taken from its render again, where that has the same bytes. Thread-safe.
class FrozenPictures {
 public:
  /// Makes their folders in the data folder (mode 0700) and removes files that a killed process
  /// left half written.
  FrozenPictures(storage::Studies& studies_, RenderService& renders_,
                 const std::filesystem::path& data);

  /// Keeps a picture and returns its digest.
  std::string freeze(const std::string& png);

  /// Verified bytes. Throws Error `storage`, which names no path, where there are none.
  std::string read(const std::string& digest);

  /// The same pixels as lossless WebP, for browsers that take it. They are computed once and kept
  /// under a seal of their own; where that does not fit, they are computed from the PNG again.
  /// Empty where WebP cannot hold a picture so large. Throws as read.
  std::optional<std::string> read_webp(const std::string& digest);

  /// The file's bytes if they have the digest; no look at renders.
  std::optional<std::string> read_file(const std::string& digest);

  /// The same; a name that no file has is no damage.
  std::optional<std::string> read_stored(const std::string& digest);

  /// Reads the pictures of all open studies; those whose file did not change since it was last read
  /// are taken as they were.
  void check();

  /// Pictures that were asked for or checked and have no right bytes.
  std::size_t damaged() const;

 private:
  using Signature = std::array<long long, 5>;  ///< of stat: changes when the file does

  std::filesystem::path file_of(const std::string& digest) const;
  std::optional<Signature> signature_of(const std::string& digest) const;
  SharedBytes source_of(const std::string& render);
  std::optional<std::string> redraw(const std::string& digest);

  storage::Studies& studies;
  RenderService& renders;
  std::filesystem::path folder;
  std::filesystem::path webp_folder;  ///< derived from the pictures: no part of backups
  mutable std::mutex mutex;
  std::map<std::string, Signature> verified;
  std::set<std::string> wrong;
};

}  // namespace penumbra::server::http
