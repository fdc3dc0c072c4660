#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace penumbra::server::storage {

/// Called for every sealed row that a statement inserts, changes or deletes.
using RowChanged = std::function<void(const std::string& table, std::int64_t row)>;

/// Keyed digests of rows: every table with a column `seal` keeps an HMAC-SHA-256 of the names and
/// values of its other columns there, so that flipped bytes in the database are seen. The columns
/// are read from the schema; columns that are NULL take no part, so that a later migration can add
/// one.
class Seals {
 public:
  explicit Seals(std::string key_) : key(std::move(key_)) {}

  /// Adds the SQL function row_seal(table, name, value, ...) to a connection.
  void add_function(SQLite::Database& connection) const;

  /// Adds a temporary view checked_TABLE for each sealed table: its columns and `intact`.
  static void add_views(SQLite::Database& connection);

  /// Adds temporary triggers that seal what is written, tell `changed`, and refuse to change a row
  /// whose seal does not fit, which would hide the damage. `changed` must outlive the connection.
  static void add_triggers(SQLite::Database& connection, const RowChanged& changed);

  /// Seals every row without a look at what it was.
  static void seal_all(SQLite::Database& connection);

  static std::vector<std::string> sealed_tables(SQLite::Database& connection);

 private:
  std::string key;
};

/// Message of the trigger that refuses to change a damaged row.
inline const std::string damaged_row_message = "the row is damaged";

/// The key of a data folder, which is made where it is missing (mode 0600).
std::string make_seal_key(const std::filesystem::path& file);

}  // namespace penumbra::server::storage
