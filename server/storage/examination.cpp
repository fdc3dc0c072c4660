#include "server/storage/examination.h"

#include "server/storage/seals.h"

namespace penumbra::server::storage {
namespace {

/// The ledger's line, and the journal up to it.
void read_ledger(SQLite::Database& connection, const Journal& journal, Owner owner,
                 Examination& found) {
  const auto tell = [&](const std::string& what) {
    found.damage.push_back({ledger_table, 1, "", what});
  };
  SQLite::Statement query(connection,
                          "SELECT commits, logged, unlogged, intact FROM checked_ledger");
  if (!query.executeStep() || query.getColumn(3).getInt() == 0)
    return tell(unfit + ": the key is another, or the row is damaged");
  found.commits = static_cast<std::uint64_t>(query.getColumn(0).getInt64());
  const auto logged = static_cast<std::uint64_t>(query.getColumn(1).getInt64());
  found.journal = journal.read(owner == Owner::another ? found.commits : UINT64_MAX);
  auto& state = found.journal;
  if (!state.exists) return tell("its journal is missing");
  if (state.damaged) return tell("its journal is damaged");
  found.journal_whole = state.commit >= logged;
  if (state.commit > found.commits)
    return tell("the database lacks the last " + std::to_string(state.commit - found.commits) +
                " commits that were acknowledged");
  if (state.commit == found.commits) return;
  if (!found.journal_whole) return tell("its journal lacks commits");
  for (const auto& [name, seal] : rows_of(query.getColumn(2).getString())) {
    if (seal.empty())
      state.rows.erase(name);
    else
      state.rows[name] = seal;
  }
  state.commit = found.commits;
  found.journal_behind = true;
}

void check_table(SQLite::Database& connection, const std::string& table, RowSeals& expected,
                 std::vector<Damage>& damage) {
  SQLite::Statement query(connection,
                          "SELECT row, seal, intact FROM checked_" + table + " ORDER BY row");
  while (query.executeStep()) {
    const RowName name{table, query.getColumn(0).getInt64()};
    const auto known = expected.find(name);
    std::string what;
    if (query.getColumn(2).getInt() == 0)
      what = unfit;
    else if (known == expected.end())
      what = "the journal does not know it";
    else if (known->second != query.getColumn(1).getString())
      what = "it is older than what was acknowledged";
    if (known != expected.end()) expected.erase(known);
    if (!what.empty())
      damage.push_back({table, name.second, participant_of(connection, name), what});
  }
}

}  // namespace

std::string text_of(const Damage& damage) {
  return damage.table + " " + std::to_string(damage.row) +
         (damage.participant.empty() ? "" : " of " + damage.participant) + ": " + damage.what;
}

Examination examine(SQLite::Database& connection, const Journal& journal, Owner owner) {
  Examination found;
  read_ledger(connection, journal, owner, found);
  auto expected = found.journal.rows;
  for (const auto& table : Seals::sealed_tables(connection))
    if (table != ledger_table) check_table(connection, table, expected, found.damage);
  for (const auto& [name, seal] : expected)
    found.damage.push_back({name.first, name.second, "", "it was acknowledged and is missing"});
  return found;
}

RowSeals seals_of(SQLite::Database& connection) {
  RowSeals rows;
  for (const auto& table : Seals::sealed_tables(connection)) {
    if (table == ledger_table) continue;
    SQLite::Statement query(connection, "SELECT rowid, seal FROM main." + table);
    while (query.executeStep())
      rows[{table, query.getColumn(0).getInt64()}] = query.getColumn(1).getString();
  }
  return rows;
}

std::string participant_of(SQLite::Database& connection, const RowName& name) {
  const bool person = name.first == "participants";
  if (!person && name.first != "answers" && name.first != "exclusions") return {};
  const std::string key =
      person ? "?" : "(SELECT participant FROM main." + name.first + " WHERE rowid = ?)";
  SQLite::Statement query(connection, "SELECT pseudonym FROM main.participants WHERE id = " + key);
  query.bind(1, name.second);
  return query.executeStep() ? query.getColumn(0).getString() : "";
}

}  // namespace penumbra::server::storage
