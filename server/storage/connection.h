#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <map>
#include <memory>
#include <string>

namespace penumbra::server::storage {

/// A connection that keeps what it has prepared: preparing a change compiles the triggers of its
/// table too, which costs several times the change itself.
class Connection : public SQLite::Database {
  struct Prepared {
    std::unique_ptr<SQLite::Statement> statement;
    bool in_use = false;
  };

 public:
  /// `flags` of sqlite3_open_v2; waits up to `busy_ms` for locks. Throws SQLite::Exception.
  Connection(const std::string& path, int flags, int busy_ms);

  /// A kept statement for the length of a block; reset at its end.
  class Query {
   public:
    explicit Query(Prepared& prepared_);
    ~Query();
    Query(const Query&) = delete;
    Query& operator=(const Query&) = delete;
    SQLite::Statement* operator->() { return prepared.statement.get(); }
    SQLite::Statement& operator*() { return *prepared.statement; }

   private:
    Prepared& prepared;
  };

  /// Throws std::logic_error where the same text is in use already.
  Query query(const std::string& text);

 private:
  std::map<std::string, Prepared> statements;
};

}  // namespace penumbra::server::storage
