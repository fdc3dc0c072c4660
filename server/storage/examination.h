#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string>
#include <vector>

#include "server/storage/journal.h"

namespace penumbra::server::storage {

/// Something in the database that is not as it was stored.
struct Damage {
  std::string table;
  std::int64_t row = 0;
  std::string participant;  ///< pseudonym, where the row belongs to a person
  std::string what;

  bool operator==(const Damage&) const = default;
};

/// The table that holds the count of commits.
inline constexpr const char* ledger_table = "ledger";

/// Of a row whose seal is not that of its values.
inline const std::string unfit = "its digest does not fit";

/// "answers 12 of p-abc: its digest does not fit"
std::string text_of(const Damage& damage);

struct Examination {
  std::vector<Damage> damage;
  std::uint64_t commits = 0;    ///< of the database
  Journal::State journal;       ///< with what the database alone knew of its last commits
  bool journal_behind = false;  ///< the journal's file lacks those
  bool journal_whole = false;   ///< it says which rows there must be
};

/// Whether another process may be writing: its journal may be ahead of the snapshot then.
enum class Owner { this_process, another };

/// Compares every sealed row with its digest and with the journal. Needs the views of Seals.
Examination examine(SQLite::Database& connection, const Journal& journal, Owner owner);

/// Seals of all rows but the ledger's.
RowSeals seals_of(SQLite::Database& connection);

/// Pseudonym of the person a row belongs to, or empty.
std::string participant_of(SQLite::Database& connection, const RowName& name);

}  // namespace penumbra::server::storage
