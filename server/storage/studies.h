#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/database.h"

namespace penumbra::server::storage {

/// One version of a study. Times are UTC, ISO 8601.
struct StudyRecord {
  std::string id;
  int version = 1;
  std::string status;       ///< draft, publishing, open, closed
  nlohmann::json document;  ///< as it was sent
  std::string hash;         ///< empty until frozen
  std::uint64_t seed = 0;   ///< of the order of pages and pictures; below 2^53
  int pictures_done = 0;
  int pictures_total = 0;
  nlohmann::json error;  ///< null, or why the last publication failed
  std::string created_at;
  std::string opened_at;  ///< empty until open
  std::string closed_at;  ///< empty until closed
};

/// A picture frozen with a version.
struct FrozenPicture {
  std::string render;       ///< its id, or SHA-256 of one's own picture as it was uploaded
  std::string digest;       ///< SHA-256 of the PNG
  nlohmann::json measures;  ///< {name: number} of the render; null until it was measured
};

/// Pictures of a version.
struct PictureCounts {
  int frozen = 0;
  int measured = 0;
};

struct StudyCounts {
  int entered = 0;  ///< tests and withdrawn people left out
  int completed = 0;
  int withdrawn = 0;
  int tests = 0;
};

/// Studies and their frozen pictures.
class Studies {
 public:
  explicit Studies(Database& database_) : database(database_) {}

  /// Stores the document as draft: replaces the draft there is, with its previews, otherwise starts
  /// version 1, or the version after the last published one. A document that a version has already
  /// changes nothing, and that version is returned. Throws `conflict` while that study is being
  /// published.
  StudyRecord put_draft(const std::string& id, const nlohmann::json& document, std::uint64_t seed,
                        const std::string& now);

  /// The version of each study that `current` returns, by id.
  std::vector<StudyRecord> list();
  /// The version that a study is known by: the one being published, otherwise the open one,
  /// otherwise the latest. A draft beside an open version hides it from no one.
  std::optional<StudyRecord> current(const std::string& id);
  /// All versions, the latest first.
  std::vector<StudyRecord> versions(const std::string& id);
  /// The version that was never opened: draft or publishing.
  std::optional<StudyRecord> draft(const std::string& id);
  std::optional<StudyRecord> find(const std::string& id, int version);
  /// The version that takes participants.
  std::optional<StudyRecord> open_version(const std::string& id);
  /// The newest version that people can have answered: open or closed.
  std::optional<StudyRecord> latest_published(const std::string& id);
  std::vector<StudyRecord> being_published();

  /// draft -> publishing, under its hash. Throws `conflict` for any other state.
  void start_publishing(const std::string& id, int version, const std::string& hash, int pictures);
  void count_picture(const std::string& id, int version, const std::string& request,
                     const FrozenPicture& picture);
  /// Keeps what was measured of a frozen picture, by name.
  void set_measures(const std::string& id, int version, const std::string& request,
                    const nlohmann::json& measures);
  PictureCounts picture_counts(const std::string& id, int version);
  /// publishing -> open; an open earlier version is closed.
  void open(const std::string& id, int version, const std::string& now);
  /// publishing -> draft, with the reason.
  void fail_publishing(const std::string& id, int version, const nlohmann::json& error);
  /// open -> closed. Throws `conflict` where no version is open.
  void close(const std::string& id, const std::string& now);
  /// closed -> open. Throws `conflict` where the version is not closed, or another one is open.
  void reopen(const std::string& id, int version);
  /// Removes a version that was never opened, and its previews. Throws `conflict` for any other.
  void remove_draft(const std::string& id, int version);

  /// By the SHA-256 of the render request's JSON.
  std::map<std::string, FrozenPicture> pictures(const std::string& id, int version);
  /// Digests of all pictures of open versions.
  std::vector<std::string> digests_of_open();
  /// Renders that a picture was frozen from.
  std::vector<std::string> renders_of_picture(const std::string& digest);
  StudyCounts counts(const std::string& id, int version);

 private:
  Database& database;
};

}  // namespace penumbra::server::storage
