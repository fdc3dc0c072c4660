#include "server/storage/sweeps.h"

namespace penumbra::server::storage {

void SweepRequests::put(const std::string& id, const nlohmann::json& request,
                        const std::string& now) {
  database.write([&](SQLite::Database& connection) {
    SQLite::Statement insert(connection,
                             "INSERT INTO sweeps (sweep, request, created_at) VALUES (?, ?, ?)");
    insert.bind(1, id);
    insert.bind(2, request.dump());
    insert.bind(3, now);
    insert.exec();
  });
}

std::optional<nlohmann::json> SweepRequests::find(const std::string& id) {
  return database.read([&](SQLite::Database& connection) -> std::optional<nlohmann::json> {
    SQLite::Statement query(connection, "SELECT request FROM sweeps WHERE sweep = ?");
    query.bind(1, id);
    if (!query.executeStep()) return std::nullopt;
    return nlohmann::json::parse(query.getColumn(0).getString());
  });
}

}  // namespace penumbra::server::storage
