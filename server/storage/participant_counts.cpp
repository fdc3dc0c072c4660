#include "server/storage/participants.h"

namespace penumbra::server::storage {

std::vector<Participants::Progress> Participants::progress(const std::string& study, int version) {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection,
                            "SELECT p.id, p.place, a.page FROM participants AS p JOIN answers AS a "
                            "ON a.participant = p.id WHERE p.study = ? AND p.version = ? AND "
                            "p.test = 0 AND a.is_current = 1 ORDER BY p.id, a.page");
    query.bind(1, study);
    query.bind(2, version);
    std::vector<Progress> found;
    std::int64_t person = -1;
    while (query.executeStep()) {
      if (query.getColumn(0).getInt64() != person) {
        person = query.getColumn(0).getInt64();
        found.push_back({static_cast<std::size_t>(query.getColumn(1).getInt64()), {}});
      }
      found.back().pages.push_back(query.getColumn(2).getInt());
    }
    return found;
  });
}

std::map<std::string, int> Participants::entries_by_person(const std::string& study) {
  return database.read([&](SQLite::Database& connection) {
    SQLite::Statement query(connection,
                            "SELECT person_id, COUNT(*) FROM participants WHERE study = ? AND "
                            "test = 0 AND person_id IS NOT NULL GROUP BY 1 HAVING COUNT(*) > 1");
    query.bind(1, study);
    std::map<std::string, int> found;
    while (query.executeStep()) found[query.getColumn(0).getString()] = query.getColumn(1).getInt();
    return found;
  });
}

}  // namespace penumbra::server::storage
