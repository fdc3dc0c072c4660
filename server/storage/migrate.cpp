#include "server/storage/migrate.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <vector>

#include "renderer/error.h"
#include "server/storage/examination.h"
#include "server/storage/seals.h"

namespace penumbra::server::storage {
namespace {

int number_of(const EmbeddedFile& file) {
  const auto name = file.path.substr(file.path.rfind('/') + 1);
  int number = 0;
  std::from_chars(name.data(), name.data() + name.size(), number);
  return number;
}

constexpr int first_with_seals = 4;  // migration that added them

void seal_first_time(SQLite::Database& connection) {
  Seals::seal_all(connection);
  SQLite::Statement rows(connection, "UPDATE ledger SET unlogged = ?");
  rows.bind(1, text_of(seals_of(connection)));
  rows.exec();
  Seals::seal_all(connection);
}

int version_of(SQLite::Database& connection) {
  return connection.execAndGet("PRAGMA user_version").getInt();
}

}  // namespace

bool has_seals(SQLite::Database& connection) {
  return version_of(connection) >= first_with_seals;
}

void migrate(SQLite::Database& connection) {
  std::vector<EmbeddedFile> files(migrations().begin(), migrations().end());
  std::sort(files.begin(), files.end(),
            [](const auto& a, const auto& b) { return a.path < b.path; });
  const int present = version_of(connection);
  const int newest = files.empty() ? 0 : number_of(files.back());
  if (present > newest)
    throw Error("storage", "the data folder was written by a newer version of the program", "data");
  for (const auto& file : files) {
    if (number_of(file) <= present) continue;
    SQLite::Transaction transaction(connection, SQLite::TransactionBehavior::IMMEDIATE);
    connection.exec(std::string(file.text));
    // Rows from before there were seals; a later file that changes rows seals those it changed.
    if (number_of(file) == first_with_seals) seal_first_time(connection);
    connection.exec("PRAGMA user_version = " + std::to_string(number_of(file)));
    transaction.commit();
  }
}

}  // namespace penumbra::server::storage
