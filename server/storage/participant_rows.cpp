#include "server/storage/participant_rows.h"

namespace penumbra::server::storage {

const char* const participant_columns =
    "id, pseudonym, study, version, place, test, token, withdrawal_code, enrolment_id, language, "
    "consent_version, parameters, details, entered_at, completed_at, person_id, "
    "seen_at, intact";

Error damaged_row() {
  return {"storage", "what is stored here is damaged"};
}

void report_row(Database& database, SQLite::Database& connection, const std::string& table,
                std::int64_t row) {
  database.report({table, row, participant_of(connection, {table, row}), unfit});
}

std::optional<ParticipantRecord> participant_of_row(Database& database, SQLite::Statement& row) {
  if (row.getColumn(17).getInt() == 0) {
    database.report(
        {"participants", row.getColumn(0).getInt64(), row.getColumn(1).getString(), unfit});
    return std::nullopt;
  }
  ParticipantRecord record;
  record.key = row.getColumn(0).getInt64();
  record.pseudonym = row.getColumn(1).getString();
  record.study = row.getColumn(2).getString();
  record.version = row.getColumn(3).getInt();
  record.place = static_cast<std::size_t>(row.getColumn(4).getInt64());
  record.test = row.getColumn(5).getInt() != 0;
  record.token = row.getColumn(6).getString();
  record.withdrawal_code = row.getColumn(7).getString();
  record.enrolment_id = row.getColumn(8).getString();
  record.language = row.getColumn(9).getString();
  record.consent_version = row.getColumn(10).getString();
  record.parameters = nlohmann::json::parse(row.getColumn(11).getString());
  record.details = nlohmann::json::parse(row.getColumn(12).getString());
  record.entered_at = row.getColumn(13).getString();
  if (!row.getColumn(14).isNull()) record.completed_at = row.getColumn(14).getString();
  if (!row.getColumn(15).isNull()) record.person_id = row.getColumn(15).getString();
  record.seen_at = row.getColumn(16).getString();
  return record;
}

std::optional<ParticipantRecord> find_where(Database& database, Connection& connection,
                                            const std::string& condition, const std::string& a,
                                            const std::string& b) {
  auto query = connection.query(std::string("SELECT ") + participant_columns +
                                " FROM checked_participants WHERE " + condition);
  query->bind(1, a);
  if (!b.empty()) query->bind(2, b);
  if (!query->executeStep()) return std::nullopt;
  auto record = participant_of_row(database, *query);
  if (!record) throw damaged_row();
  return record;
}

}  // namespace penumbra::server::storage
