#include "server/storage/connection.h"

#include <sqlite3.h>

#include <stdexcept>

namespace penumbra::server::storage {

Connection::Connection(const std::string& path, int flags, int busy_ms)
    : SQLite::Database(path, flags, busy_ms) {
  // Without this, a statement whose plan could depend on a bound value is compiled again at each
  // binding, and keeping it prepared gains nothing.
  const int state =
      sqlite3_db_config(getHandle(), SQLITE_DBCONFIG_ENABLE_QPSG, 1, static_cast<int*>(nullptr));
  if (state != SQLITE_OK) throw SQLite::Exception(getHandle(), state);
}

Connection::Query::Query(Prepared& prepared_) : prepared(prepared_) {
  if (prepared.in_use) throw std::logic_error("a kept statement is in use already");
  prepared.in_use = true;
}

Connection::Query::~Query() {
  // Its last failure was thrown when it happened; here it is only reset.
  prepared.statement->tryReset();
  prepared.statement->clearBindings();
  prepared.in_use = false;
}

Connection::Query Connection::query(const std::string& text) {
  auto& prepared = statements[text];
  if (!prepared.statement) {
    try {
      prepared.statement = std::make_unique<SQLite::Statement>(*this, text);
    } catch (...) {
      statements.erase(text);
      throw;
    }
  }
  return Query(prepared);
}

}  // namespace penumbra::server::storage
