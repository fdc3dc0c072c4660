#include "server/storage/repair.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "renderer/error.h"
#include "server/files/digest.h"
#include "server/files/durable_file.h"
#include "server/storage/backup.h"
#include "server/storage/data_folder.h"
#include "server/storage/examination.h"
#include "server/storage/folder_files.h"
#include "server/storage/migrate.h"
#include "server/storage/seals.h"

namespace penumbra::server::storage {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A row by the names of its columns, without its seal.
using Values = std::vector<std::pair<std::string, json>>;

json value_of(const SQLite::Column& column) {
  if (column.isInteger()) return column.getInt64();
  if (column.isFloat()) return column.getDouble();
  if (column.isNull()) return nullptr;
  const std::string bytes = column.getString();
  if (column.isBlob()) return json::binary({bytes.begin(), bytes.end()});
  return bytes;
}

void bind(SQLite::Statement& statement, int index, const json& value) {
  if (value.is_null()) {
    statement.bind(index);
  } else if (value.is_number_float()) {
    statement.bind(index, value.get<double>());
  } else if (value.is_number()) {
    statement.bind(index, value.get<std::int64_t>());
  } else if (value.is_binary()) {
    const auto& bytes = value.get_binary();
    statement.bind(index, bytes.data(), static_cast<int>(bytes.size()));
  } else {
    statement.bind(index, value.get<std::string>());
  }
}

struct Row {
  RowName name;
  Values values;
  std::string seal;
  bool intact = false;
};

/// Rows of a sealed table of which some pages may be damaged: from the front as far as they can be
/// read, and then from the back.
std::vector<Row> readable_rows(SQLite::Database& from, const std::string& table) {
  std::vector<Row> rows;
  std::set<std::int64_t> seen;
  for (const char* order : {"", " DESC"}) {
    try {
      SQLite::Statement query(from, "SELECT * FROM checked_" + table + " ORDER BY row" + order);
      while (query.executeStep()) {
        Row row{{table, query.getColumn("row").getInt64()}, {}, "", false};
        if (!seen.insert(row.name.second).second) break;
        row.seal = query.getColumn("seal").getString();
        row.intact = query.getColumn("intact").getInt() != 0;
        for (int i = 0; i < query.getColumnCount(); ++i) {
          const std::string name = query.getColumnName(i);
          if (name != "row" && name != "seal" && name != "intact")
            row.values.emplace_back(name, value_of(query.getColumn(i)));
        }
        rows.push_back(std::move(row));
      }
    } catch (const SQLite::Exception&) {
      continue;  // this page and what is behind it cannot be read in this order
    }
    if (std::string(order).empty()) break;  // all of it was read
  }
  return rows;
}

/// A database on which rows and digests can be read.
struct Opened {
  Opened(const fs::path& file, const std::string& key, int flags)
      : connection(file.string(), flags) {
    Seals(key).add_function(connection);
  }
  SQLite::Database connection;
};

class Rebuild {
 public:
  Rebuild(const fs::path& old_file, const fs::path& new_file, std::string old_key_,
          std::string new_key, const Journal& journal_)
      : journal(journal_),
        from(old_file, old_key_, SQLite::OPEN_READWRITE),
        to(new_file, new_key, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE) {}

  /// Fills the new database; true where anything could be read.
  bool run() {
    to.connection.exec("PRAGMA synchronous = FULL");
    migrate(to.connection);
    read_old();
    {
      SQLite::Transaction transaction(to.connection);
      for (const auto& row : rows) take(row);
      drop_orphans();
      note_missing();
      seal();
      transaction.commit();
    }
    return !rows.empty();
  }

  std::vector<std::string> lines;  ///< about rows that were not taken
  std::string file;                ///< the same with values, a JSON document a line
  std::size_t kept = 0;
  Journal::State state;  ///< for the new journal

 private:
  void read_old() {
    try {
      migrate(from.connection);
      Seals::add_views(from.connection);
    } catch (const std::exception&) {
      return;  // not even the list of tables can be read
    }
    for (const auto& table : Seals::sealed_tables(to.connection)) {
      if (table == ledger_table) continue;
      auto more = readable_rows(from.connection, table);
      rows.insert(rows.end(), std::make_move_iterator(more.begin()),
                  std::make_move_iterator(more.end()));
    }
    // With another key no digest fits, and none says anything.
    proved = std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.intact; });
    read_journal();
  }

  void read_journal() {
    state = journal.read();
    known = proved && state.commit > 0 && !state.damaged && !state.torn;
    try {
      const auto found = examine(from.connection, journal, Owner::this_process);
      state.commit = std::max(state.commit, found.commits);
      if (found.commits == 0) return;  // its line of the ledger is damaged
      known = proved && found.journal_whole;
      if (known) state.rows = found.journal.rows;
    } catch (const std::exception&) {
      return;  // pages of the database cannot be read
    }
  }

  void take(const Row& row) {
    if (proved && !row.intact) return set_aside(row.name, unfit, row.values);
    if (known) {
      const auto expected = state.rows.find(row.name);
      if (expected == state.rows.end())
        return set_aside(row.name, "the journal does not know it", row.values);
      if (expected->second != row.seal)
        note(row.name, "it is older than what was acknowledged, and kept", row.values);
    } else if (!proved) {
      note(row.name, "its digest could not be checked, and it is kept", row.values);
    }
    try {
      insert(row);
      ++kept;
      if (known) state.rows.erase(row.name);
    } catch (const SQLite::Exception& error) {
      set_aside(row.name, error.what(), row.values);
    }
  }

  void insert(const Row& row) {
    SQLite::Statement alias(to.connection,
                            "SELECT COUNT(*) FROM pragma_table_info(?) WHERE pk = 1 AND "
                            "type = 'INTEGER'");
    alias.bind(1, row.name.first);
    alias.executeStep();
    std::string columns;
    std::string places;
    if (alias.getColumn(0).getInt() == 0) {
      columns = "rowid, ";
      places = "?, ";
    }
    const int first = places.empty() ? 1 : 2;
    for (const auto& [name, value] : row.values) {
      columns += "\"" + name + "\", ";
      places += "?, ";
    }
    columns.resize(columns.size() - 2);
    places.resize(places.size() - 2);
    SQLite::Statement statement(to.connection, "INSERT INTO " + row.name.first + " (" + columns +
                                                   ") VALUES (" + places + ")");
    if (first == 2) statement.bind(1, row.name.second);
    for (std::size_t i = 0; i < row.values.size(); ++i)
      bind(statement, static_cast<int>(i) + first, row.values[i].second);
    statement.exec();
  }

  /// Rows that belong to one that is not there any more.
  void drop_orphans() {
    while (true) {
      std::set<RowName> orphans;
      std::map<RowName, std::string> parents;
      SQLite::Statement check(to.connection, "PRAGMA foreign_key_check");
      while (check.executeStep())
        parents[{check.getColumn(0).getString(), check.getColumn(1).getInt64()}] =
            check.getColumn(2).getString();
      if (parents.empty()) return;
      for (const auto& [name, parent] : parents) {
        const auto row = std::find_if(rows.begin(), rows.end(), [&, &wanted = name](const Row& r) {
          return r.name == wanted;
        });
        SQLite::Statement remove(to.connection, "DELETE FROM " + name.first + " WHERE rowid = ?");
        remove.bind(1, name.second);
        remove.exec();
        --kept;
        set_aside(name, "its row of " + parent + " is not there",
                  row == rows.end() ? Values{} : row->values);
      }
    }
  }

  void note_missing() {
    if (!known) return;
    std::set<RowName> told = aside;
    for (const auto& [name, seal] : state.rows)
      if (!told.contains(name)) note(name, "it was acknowledged and is missing", {{"seal", seal}});
  }

  void seal() {
    Seals::seal_all(to.connection);
    ++state.commit;
    SQLite::Statement update(to.connection,
                             "UPDATE ledger SET commits = ?, logged = ?, unlogged = ''");
    update.bind(1, static_cast<std::int64_t>(state.commit));
    update.bind(2, static_cast<std::int64_t>(state.commit));
    update.exec();
    Seals::seal_all(to.connection);
    state.rows = seals_of(to.connection);
  }

  void set_aside(const RowName& name, const std::string& what, const Values& values) {
    aside.insert(name);
    note(name, what, values);
  }

  void note(const RowName& name, const std::string& what, const Values& values) {
    std::string person;
    try {
      person = participant_of(from.connection, name);
    } catch (const SQLite::Exception&) {
      person.clear();  // that page cannot be read
    }
    lines.push_back(text_of(Damage{name.first, name.second, person, what}));
    json all = json::object();
    for (const auto& [column, value] : values) all[column] = value;
    const json line = {
        {"table", name.first}, {"row", name.second}, {"what", what}, {"values", all}};
    file += line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  }

  const Journal& journal;
  Opened from;
  Opened to;
  std::vector<Row> rows;
  std::set<RowName> aside;
  bool proved = false;  ///< the key is the one that the digests were made with
  bool known = false;   ///< the journal says which rows there must be
};

fs::path new_folder(const fs::path& data) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char text[32];
  std::strftime(text, sizeof text, "damaged-%Y%m%dT%H%M%SZ", std::gmtime(&now));
  fs::path folder = data / text;
  for (int i = 2; fs::exists(folder); ++i)
    folder = data / (std::string(text) + "-" + std::to_string(i));
  make_private_folder(folder);
  return folder;
}

void close_to_others(const fs::path& path) {
  std::error_code failure;
  if (!fs::exists(path, failure)) return;
  fs::permissions(path, fs::perms::group_all | fs::perms::others_all, fs::perm_options::remove);
}

void rebuild_database(const fs::path& data, Repair& repair) {
  for (const char* name : {database_name, database_log_name, journal_name, key_name})
    if (const auto bytes = read_whole(data / name))
      write_file_durably(repair.folder / name, *bytes);

  const PassingFolder passing(repair.folder / "work");
  const auto& work = passing.path;
  for (const char* name : {database_name, database_log_name})
    if (fs::exists(data / name)) fs::copy_file(data / name, work / name);
  const auto old_key = read_whole(data / key_name);
  const auto key = old_key ? *old_key : random_bytes(32);
  Journal journal(data / journal_name, key);
  {
    Rebuild rebuild(work / database_name, work / "new.sqlite", key, key, journal);
    if (!rebuild.run())
      throw Error("storage",
                  "nothing of the database can be read; restore a backup. It is as it was, with a "
                  "copy in " +
                      repair.folder.string(),
                  "data");
    repair.kept = rebuild.kept;
    repair.aside = rebuild.lines;
    write_file_durably(repair.folder / "rows.jsonl", rebuild.file);
    // The log belongs to the old file and must not be replayed into the new one.
    if (!old_key) write_file_durably(data / key_name, key);
    journal.compact(rebuild.state);
  }
  for (const char* name : {database_log_name, database_index_name}) fs::remove(data / name);
  write_file_durably(data / database_name, read_file(work / "new.sqlite"));
}

void move_altered_pictures(const fs::path& data, const fs::path& folder) {
  const auto pictures = data / pictures_name;
  if (!fs::is_directory(pictures)) return;
  for (const auto& entry : fs::directory_iterator(pictures)) {
    const auto bytes = read_whole(entry.path());
    if (bytes && sha256(*bytes) == entry.path().stem()) continue;
    make_private_folder(folder / pictures_name);
    fs::rename(entry.path(), folder / pictures_name / entry.path().filename());
  }
}

std::vector<std::string> missing_pictures(const fs::path& data) {
  SQLite::Database connection((data / database_name).string(), SQLite::OPEN_READONLY);
  SQLite::Statement query(connection, "SELECT DISTINCT digest FROM pictures ORDER BY 1");
  std::vector<std::string> missing;
  while (query.executeStep()) {
    const auto digest = query.getColumn(0).getString();
    if (!fs::exists(data / pictures_name / (digest + ".png"))) missing.push_back(digest);
  }
  return missing;
}

}  // namespace

Repair repair_folder(const fs::path& data) {
  Repair repair;
  repair.found = verify_folder(data);
  const DataFolder lock(data);
  if (repair.found.empty()) return repair;
  close_to_others(data);
  for (const char* name : secret_names) close_to_others(data / name);
  repair.folder = new_folder(data);
  rebuild_database(data, repair);
  move_altered_pictures(data, repair.folder);
  repair.pictures = missing_pictures(data);
  return repair;
}

}  // namespace penumbra::server::storage
