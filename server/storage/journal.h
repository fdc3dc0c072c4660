#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace penumbra::server::storage {

/// A row of a table.
using RowName = std::pair<std::string, std::int64_t>;

/// What a commit did: the seal of each row that it wrote, empty where it deleted the row.
using RowSeals = std::map<RowName, std::string>;

/// "TABLE ROW SEAL;..." with "-" for a deleted row, and back. Throws Error `storage`.
std::string text_of(const RowSeals& rows);
RowSeals rows_of(const std::string& text);

/// A file beside the database that holds, for every commit, the seals of its rows and nothing else:
/// it knows which rows there must be when SQLite's own log has lost some. A line per commit,
/// "NUMBER ROWS DIGEST", where the digest is keyed; written and synced after the commit and before
/// it is acknowledged.
class Journal {
 public:
  Journal(std::filesystem::path file_, std::string key_)
      : file(std::move(file_)), key(std::move(key_)) {}
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  struct State {
    bool exists = false;
    bool torn = false;         ///< the last line was not written whole
    bool damaged = false;      ///< a line before the last does not fit its digest
    std::uint64_t commit = 0;  ///< number of the last one
    RowSeals rows;             ///< that there must be
    std::uint64_t bytes = 0;   ///< of the file
  };
  /// All commits up to number `last`. A last line that was not written whole is left out: its
  /// commit was not acknowledged.
  State read(std::uint64_t last = UINT64_MAX) const;

  /// Appends a commit and syncs. Throws Error `storage`; the file is then as it was.
  void append(std::uint64_t commit, const std::string& rows);

  /// Writes the file anew with the rows that there are, and no trace of those that went.
  void compact(const State& state);

 private:
  std::string line_of(std::uint64_t commit, const std::string& rows) const;
  void open();

  std::filesystem::path file;
  std::string key;
  int descriptor = -1;
};

}  // namespace penumbra::server::storage
