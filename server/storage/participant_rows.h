#pragma once

#include <optional>
#include <string>

#include "renderer/error.h"
#include "server/storage/participants.h"

namespace penumbra::server::storage {

/// Columns of checked_participants that participant_of_row reads, in its order.
extern const char* const participant_columns;

/// Nothing where the row is damaged, which is reported.
std::optional<ParticipantRecord> participant_of_row(Database& database, SQLite::Statement& row);

/// The person for whom `condition` with its one or two values holds. Throws Error `storage` where
/// that row is damaged.
std::optional<ParticipantRecord> find_where(Database& database, Connection& connection,
                                            const std::string& condition, const std::string& a,
                                            const std::string& b = {});

Error damaged_row();

/// Notes a row whose digest does not fit, with the person it belongs to.
void report_row(Database& database, SQLite::Database& connection, const std::string& table,
                std::int64_t row);

}  // namespace penumbra::server::storage
