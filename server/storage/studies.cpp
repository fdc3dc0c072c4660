#include "server/storage/studies.h"

#include "renderer/error.h"

namespace penumbra::server::storage {
namespace {

constexpr const char* columns =
    "study, version, status, document, hash, seed, pictures_done, pictures_total, error, "
    "created_at, opened_at, closed_at, intact, row";

/// First the version that `current` returns.
constexpr const char* current_first =
    "CASE status WHEN 'publishing' THEN 0 WHEN 'open' THEN 1 ELSE 2 END, version DESC";

std::string select(const std::string& condition) {
  return std::string("SELECT ") + columns + " FROM checked_studies " + condition;
}

/// Throws Error `storage` where the row is damaged, which is reported.
StudyRecord record_of(Database& database, SQLite::Statement& row) {
  if (row.getColumn(12).getInt() == 0) {
    database.report({"studies", row.getColumn(13).getInt64(), "", unfit});
    throw Error("storage", "the study is damaged; restore a backup");
  }
  StudyRecord record;
  record.id = row.getColumn(0).getString();
  record.version = row.getColumn(1).getInt();
  record.status = row.getColumn(2).getString();
  record.document = nlohmann::json::parse(row.getColumn(3).getString());
  record.hash = row.getColumn(4).isNull() ? "" : row.getColumn(4).getString();
  record.seed = static_cast<std::uint64_t>(row.getColumn(5).getInt64());
  record.pictures_done = row.getColumn(6).getInt();
  record.pictures_total = row.getColumn(7).getInt();
  if (!row.getColumn(8).isNull())
    record.error = nlohmann::json::parse(row.getColumn(8).getString());
  record.created_at = row.getColumn(9).getString();
  if (!row.getColumn(10).isNull()) record.opened_at = row.getColumn(10).getString();
  if (!row.getColumn(11).isNull()) record.closed_at = row.getColumn(11).getString();
  return record;
}

std::optional<StudyRecord> first(Database& database, SQLite::Statement& query) {
  if (!query.executeStep()) return std::nullopt;
  return record_of(database, query);
}

std::vector<StudyRecord> all(Database& database, SQLite::Statement& query) {
  std::vector<StudyRecord> records;
  while (query.executeStep()) records.push_back(record_of(database, query));
  return records;
}

std::vector<std::string> texts(SQLite::Statement& query) {
  std::vector<std::string> found;
  while (query.executeStep()) found.push_back(query.getColumn(0).getString());
  return found;
}

/// Runs a statement that must change a row; otherwise the state was another than expected.
void change_one(SQLite::Statement& statement, const std::string& otherwise) {
  if (statement.exec() != 1) throw Error("conflict", otherwise, "status");
}

/// A draft goes with what researchers answered while looking at it.
void remove_version(SQLite::Database& connection, const std::string& id, int version) {
  for (const char* table : {"participants", "studies"}) {
    SQLite::Statement drop(
        connection, std::string("DELETE FROM ") + table + " WHERE study = ? AND version = ?");
    drop.bind(1, id);
    drop.bind(2, version);
    drop.exec();
  }
}

}  // namespace

StudyRecord Studies::put_draft(const std::string& id, const nlohmann::json& document,
                               std::uint64_t seed, const std::string& now) {
  return database.write([&](SQLite::Database& connection) {
    SQLite::Statement query(connection, select("WHERE study = ? ORDER BY version DESC"));
    query.bind(1, id);
    const auto known = all(database, query);
    const auto* present = known.empty() ? nullptr : &known.front();
    if (present && present->status == "publishing")
      throw Error("conflict", "study " + id + " is being published", "status");
    for (const auto& version : known)
      if (version.document == document) return version;
    StudyRecord record;
    record.id = id;
    record.status = "draft";
    record.document = document;
    record.seed = seed;
    record.created_at = now;
    if (present) record.version = present->version + (present->status == "draft" ? 0 : 1);
    if (present && present->status == "draft") remove_version(connection, id, record.version);
    SQLite::Statement insert(connection,
                             "INSERT INTO studies (study, version, status, document, seed, "
                             "created_at) VALUES (?, ?, 'draft', ?, ?, ?)");
    insert.bind(1, id);
    insert.bind(2, record.version);
    insert.bind(3, document.dump());
    insert.bind(4, static_cast<std::int64_t>(seed));
    insert.bind(5, now);
    insert.exec();
    return record;
  });
}

std::vector<StudyRecord> Studies::list() {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection, select(std::string("ORDER BY study, ") + current_first));
    std::vector<StudyRecord> records;
    while (query.executeStep())
      if (records.empty() || records.back().id != query.getColumn(0).getString())
        records.push_back(record_of(database, query));
    return records;
  });
}

std::optional<StudyRecord> Studies::current(const std::string& id) {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(
        connection, select(std::string("WHERE study = ? ORDER BY ") + current_first + " LIMIT 1"));
    query.bind(1, id);
    return first(database, query);
  });
}

std::vector<StudyRecord> Studies::versions(const std::string& id) {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection, select("WHERE study = ? ORDER BY version DESC"));
    query.bind(1, id);
    return all(database, query);
  });
}

std::optional<StudyRecord> Studies::draft(const std::string& id) {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection,
                            select("WHERE study = ? AND status IN ('draft', 'publishing')"));
    query.bind(1, id);
    return first(database, query);
  });
}

std::optional<StudyRecord> Studies::find(const std::string& id, int version) {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection, select("WHERE study = ? AND version = ?"));
    query.bind(1, id);
    query.bind(2, version);
    return first(database, query);
  });
}

std::optional<StudyRecord> Studies::open_version(const std::string& id) {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection, select("WHERE study = ? AND status = 'open'"));
    query.bind(1, id);
    return first(database, query);
  });
}

std::optional<StudyRecord> Studies::latest_published(const std::string& id) {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection, select("WHERE study = ? AND status IN ('open', 'closed') "
                                               "ORDER BY version DESC LIMIT 1"));
    query.bind(1, id);
    return first(database, query);
  });
}

std::vector<StudyRecord> Studies::being_published() {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection, select("WHERE status = 'publishing' ORDER BY study"));
    return all(database, query);
  });
}

void Studies::start_publishing(const std::string& id, int version, const std::string& hash,
                               int pictures) {
  database.write([&](SQLite::Database& connection) {
    SQLite::Statement update(
        connection,
        "UPDATE studies SET status = 'publishing', hash = ?, pictures_done = 0, "
        "pictures_total = ?, error = NULL WHERE study = ? AND version = ? AND status = 'draft'");
    update.bind(1, hash);
    update.bind(2, pictures);
    update.bind(3, id);
    update.bind(4, version);
    change_one(update, "only a draft can be published");
    SQLite::Statement drop(connection, "DELETE FROM pictures WHERE study = ? AND version = ?");
    drop.bind(1, id);
    drop.bind(2, version);
    drop.exec();
  });
}

void Studies::count_picture(const std::string& id, int version, const std::string& request,
                            const FrozenPicture& picture) {
  database.write([&](SQLite::Database& connection) {
    SQLite::Statement insert(connection,
                             "INSERT INTO pictures (study, version, request, render, digest, "
                             "measures) VALUES (?, ?, ?, ?, ?, ?) "
                             "ON CONFLICT (study, version, request) DO UPDATE SET "
                             "render = excluded.render, digest = excluded.digest, "
                             "measures = excluded.measures");
    insert.bind(1, id);
    insert.bind(2, version);
    insert.bind(3, request);
    insert.bind(4, picture.render);
    insert.bind(5, picture.digest);
    if (!picture.measures.is_null()) insert.bind(6, picture.measures.dump());
    insert.exec();
    SQLite::Statement count(connection,
                            "UPDATE studies SET pictures_done = (SELECT COUNT(*) FROM pictures "
                            "WHERE study = ?1 AND version = ?2) WHERE study = ?1 AND version = ?2");
    count.bind(1, id);
    count.bind(2, version);
    count.exec();
  });
}

void Studies::set_measures(const std::string& id, int version, const std::string& request,
                           const nlohmann::json& measures) {
  database.write([&](SQLite::Database& connection) {
    SQLite::Statement update(connection,
                             "UPDATE pictures SET measures = ? "
                             "WHERE study = ? AND version = ? AND request = ?");
    update.bind(1, measures.dump());
    update.bind(2, id);
    update.bind(3, version);
    update.bind(4, request);
    update.exec();
  });
}

PictureCounts Studies::picture_counts(const std::string& id, int version) {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection,
                            "SELECT COUNT(*), COUNT(measures) FROM pictures "
                            "WHERE study = ? AND version = ?");
    query.bind(1, id);
    query.bind(2, version);
    query.executeStep();
    return PictureCounts{query.getColumn(0).getInt(), query.getColumn(1).getInt()};
  });
}

void Studies::open(const std::string& id, int version, const std::string& now) {
  database.write([&](SQLite::Database& connection) {
    SQLite::Statement supersede(connection,
                                "UPDATE studies SET status = 'closed', closed_at = ? "
                                "WHERE study = ? AND status = 'open'");
    supersede.bind(1, now);
    supersede.bind(2, id);
    supersede.exec();
    SQLite::Statement update(connection,
                             "UPDATE studies SET status = 'open', opened_at = ? "
                             "WHERE study = ? AND version = ? AND status = 'publishing'");
    update.bind(1, now);
    update.bind(2, id);
    update.bind(3, version);
    change_one(update, "the study is not being published");
  });
}

void Studies::fail_publishing(const std::string& id, int version, const nlohmann::json& error) {
  database.write([&](SQLite::Database& connection) {
    SQLite::Statement update(connection,
                             "UPDATE studies SET status = 'draft', hash = NULL, error = ? "
                             "WHERE study = ? AND version = ? AND status = 'publishing'");
    update.bind(1, error.dump());
    update.bind(2, id);
    update.bind(3, version);
    update.exec();
  });
}

void Studies::close(const std::string& id, const std::string& now) {
  database.write([&](SQLite::Database& connection) {
    SQLite::Statement update(connection,
                             "UPDATE studies SET status = 'closed', closed_at = ? "
                             "WHERE study = ? AND status = 'open'");
    update.bind(1, now);
    update.bind(2, id);
    change_one(update, "the study is not open");
  });
}

void Studies::reopen(const std::string& id, int version) {
  database.write([&](SQLite::Database& connection) {
    SQLite::Statement update(connection,
                             "UPDATE studies SET status = 'open', closed_at = NULL "
                             "WHERE study = ?1 AND version = ?2 AND status = 'closed' AND NOT "
                             "EXISTS (SELECT 1 FROM studies WHERE study = ?1 AND status = 'open')");
    update.bind(1, id);
    update.bind(2, version);
    change_one(update, "only a closed version can be opened again, and none while another is open");
  });
}

void Studies::remove_draft(const std::string& id, int version) {
  database.write([&](SQLite::Database& connection) {
    SQLite::Statement query(connection, select("WHERE study = ? AND version = ?"));
    query.bind(1, id);
    query.bind(2, version);
    const auto found = first(database, query);
    if (!found || found->status != "draft")
      throw Error("conflict", "only a draft can be deleted: people may have answered the others",
                  "status");
    remove_version(connection, id, version);
  });
}

std::map<std::string, FrozenPicture> Studies::pictures(const std::string& id, int version) {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection,
                            "SELECT request, render, digest, intact, row, measures "
                            "FROM checked_pictures WHERE study = ? AND version = ?");
    query.bind(1, id);
    query.bind(2, version);
    std::map<std::string, FrozenPicture> found;
    while (query.executeStep()) {
      if (query.getColumn(3).getInt() == 0) {
        database.report({"pictures", query.getColumn(4).getInt64(), "", unfit});
        continue;
      }
      auto& picture = found[query.getColumn(0).getString()];
      picture.render = query.getColumn(1).getString();
      picture.digest = query.getColumn(2).getString();
      if (!query.getColumn(5).isNull())
        picture.measures = nlohmann::json::parse(query.getColumn(5).getString());
    }
    return found;
  });
}

std::vector<std::string> Studies::digests_of_open() {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection,
                            "SELECT DISTINCT p.digest FROM pictures AS p JOIN studies AS s "
                            "ON s.study = p.study AND s.version = p.version "
                            "WHERE s.status = 'open' ORDER BY 1");
    return texts(query);
  });
}

std::vector<std::string> Studies::renders_of_picture(const std::string& digest) {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection,
                            "SELECT DISTINCT render FROM pictures WHERE digest = ? ORDER BY 1");
    query.bind(1, digest);
    return texts(query);
  });
}

StudyCounts Studies::counts(const std::string& id, int version) {
  return database.read([&](SQLite::Database& connection) {
    StudyCounts counts;
    SQLite::Statement people(connection,
                             "SELECT test, completed_at IS NOT NULL, COUNT(*) FROM participants "
                             "WHERE study = ? AND version = ? GROUP BY 1, 2");
    people.bind(1, id);
    people.bind(2, version);
    while (people.executeStep()) {
      const int number = people.getColumn(2).getInt();
      if (people.getColumn(0).getInt() != 0) {
        counts.tests += number;
        continue;
      }
      counts.entered += number;
      if (people.getColumn(1).getInt() != 0) counts.completed += number;
    }
    SQLite::Statement gone(connection,
                           "SELECT COUNT(*) FROM withdrawals WHERE study = ? AND version = ?");
    gone.bind(1, id);
    gone.bind(2, version);
    gone.executeStep();
    counts.withdrawn = gone.getColumn(0).getInt();
    return counts;
  });
}

}  // namespace penumbra::server::storage
