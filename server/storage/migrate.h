#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <span>

#include "renderer/embedded_file.h"

namespace penumbra::server::storage {

/// Numbered SQL files of schema/migrations, compiled in.
std::span<const EmbeddedFile> migrations();

/// Brings the tables to the newest version. Needs the SQL function of Seals. Throws Error `storage`
/// where a newer program wrote the database.
void migrate(SQLite::Database& connection);

/// Whether the rows carry digests: databases of the first versions did not.
bool has_seals(SQLite::Database& connection);

}  // namespace penumbra::server::storage
