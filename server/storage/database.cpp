#include "server/storage/database.h"

#include <spdlog/spdlog.h>
#include <sqlite3.h>

#include <algorithm>

#include "renderer/error.h"
#include "server/storage/data_folder.h"
#include "server/storage/folder_files.h"
#include "server/storage/migrate.h"

namespace penumbra::server::storage {
namespace {

constexpr int busy_ms = 3000;               // a lock held longer than this is not waited for
constexpr std::size_t largest_batch = 256;  // changes that share one commit
constexpr int purge_busy_ms = 20;           // answers wait no longer for a withdrawal to be cleared
constexpr auto purge_pause = std::chrono::milliseconds(250);
constexpr std::int64_t log_limit = 4
                                   << 20;  // bytes that the write-ahead log keeps when it is reset

/// What a change did is undone at the end of the block unless it was released. SQLiteCpp's own one
/// compiles four statements for each change.
class Savepoint {
 public:
  explicit Savepoint(Connection& connection_) : connection(connection_) {
    connection.query("SAVEPOINT change")->exec();
  }
  ~Savepoint() {
    if (released || sqlite3_get_autocommit(connection.getHandle()) != 0) return;
    try {
      connection.query("ROLLBACK TO change")->exec();
      connection.query("RELEASE change")->exec();
    } catch (const SQLite::Exception& error) {
      spdlog::error("a change cannot be undone by itself: {}", error.what());
      connection.tryExec("ROLLBACK");  // with its neighbours then
    }
  }
  Savepoint(const Savepoint&) = delete;
  Savepoint& operator=(const Savepoint&) = delete;

  void release() {
    connection.query("RELEASE change")->exec();
    released = true;
  }

 private:
  Connection& connection;
  bool released = false;
};

/// Reading is bound by processors: more connections than those only wait for each other.
std::size_t most_readers() {
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 4, 16);
}

/// Without statistics of its memory, which all connections would keep under one lock.
void configure_sqlite() {
  static const int state = sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0);
  if (state != SQLITE_OK) spdlog::debug("SQLite keeps statistics of its memory: code {}", state);
}

}  // namespace

Database::Database(const std::filesystem::path& file)
    : path(file),
      readers(
          [this] {
            auto connection =
                std::make_unique<Connection>(path.string(), SQLite::OPEN_READONLY, busy_ms);
            prepare(*connection);
            return connection;
          },
          most_readers()) {
  configure_sqlite();
  // A damaged file is kept for repair: the server starts, says so, and writes nothing.
  try {
    guarded([&] { open_writer(); });
  } catch (const Error&) {
    if (healthy()) throw;
  }
  if (healthy()) thread = std::thread([this] { run_writer(); });
}

bool Database::holds_a_study() const {
  std::error_code failure;
  const auto pictures = path.parent_path() / pictures_name;
  return std::filesystem::is_directory(pictures, failure) &&
         !std::filesystem::is_empty(pictures, failure);
}

void Database::refuse(const std::string& why) {
  report({"database", 0, "", why});
  throw Error("storage", why, "data");
}

void Database::open_writer() {
  const auto key_file = path.parent_path() / key_name;
  const auto journal_file = path.parent_path() / journal_name;
  std::error_code failure;
  const auto size = std::filesystem::file_size(path, failure);
  const bool has_key = std::filesystem::exists(key_file);
  if (has_key) {
    seals.emplace(read_file(key_file));
    journal.emplace(journal_file, read_file(key_file));
  }
  if (failure || size == 0)
    if (holds_a_study() || (journal && journal->read().commit > 0))
      refuse("the database is missing or empty beside the files of a study");

  writer = std::make_unique<Connection>(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE,
                                        busy_ms);
  std::filesystem::permissions(
      path, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  writer->exec("PRAGMA journal_mode = WAL");
  writer->exec("PRAGMA synchronous = FULL");
  writer->exec("PRAGMA foreign_keys = ON");
  writer->exec("PRAGMA secure_delete = ON");  // who withdraws leaves no bytes behind
  writer->exec("PRAGMA journal_size_limit = " + std::to_string(log_limit));
  if (writer->execAndGet("PRAGMA integrity_check").getString() != "ok")
    refuse("its structure is damaged");

  const bool sealed = has_seals(*writer);
  if (sealed && !has_key) refuse("integrity.key is missing");
  if (!has_key) {
    const auto key = make_seal_key(key_file);
    seals.emplace(key);
    journal.emplace(journal_file, key);
  }
  if (!std::filesystem::exists(journal_file)) {
    if (sealed) refuse("answers.journal is missing");
    journal->compact({});
  }
  seals->add_function(*writer);
  migrate(*writer);
  Seals::add_views(*writer);
  check_rows();
  note_row = [this](const std::string& table, std::int64_t row) {
    if (table != "ledger") touched[{table, row}] = "";
  };
  Seals::add_triggers(*writer, note_row);
}

void Database::check_rows() {
  auto found = examine(*writer, *journal, Owner::this_process);
  for (const auto& one : found.damage) report(one);
  if (!healthy()) return;
  commits = logged = found.commits;
  // A journal that lacks the last commit, or has lines of rows that changed or went since.
  constexpr std::uint64_t spare = 1 << 20;
  if (found.journal_behind || found.journal.torn ||
      found.journal.bytes > 2 * text_of(found.journal.rows).size() + spare)
    journal->compact(found.journal);
}

Database::~Database() {
  {
    std::lock_guard lock(queue_mutex);
    stopping = true;
  }
  queue_changed.notify_all();
  if (thread.joinable()) thread.join();
}

void Database::translate(const SQLite::Exception& error) {
  ++failure_count;
  spdlog::error("database: {} (code {})", error.what(), error.getExtendedErrorCode());
  switch (error.getErrorCode()) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw Error("busy", "the database is locked");
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      damaged = true;
      throw Error("storage", "the database is damaged");
    case SQLITE_CONSTRAINT:
      if (error.what() != damaged_row_message) break;
      damaged = true;
      throw Error("storage", "the database is damaged");
    case SQLITE_FULL:
      throw Error("storage", "the disk is full");
    default:
      break;
  }
  throw Error("storage", std::string("database: ") + error.what());
}

void Database::perform(const Change& change) {
  if (!healthy()) throw Error("storage", "the database is damaged: nothing is written");
  const auto pending = std::make_shared<Pending>();
  pending->change = &change;
  {
    const std::lock_guard lock(queue_mutex);
    if (stopping) throw Error("draining", "the server is stopping");
    queue.push_back(pending);
  }
  queue_changed.notify_one();
  pending->over.acquire();
  if (pending->failure) guarded([&] { std::rethrow_exception(pending->failure); });
}

void Database::run_writer() {
  std::unique_lock lock(queue_mutex);
  while (true) {
    const auto has_work = [&] { return stopping || !queue.empty(); };
    if (purge_wanted) {
      queue_changed.wait_for(lock, purge_pause, has_work);
    } else {
      queue_changed.wait(lock, has_work);
    }
    if (queue.empty() && !stopping) {
      lock.unlock();
      clear_log();
      lock.lock();
      continue;
    }
    if (queue.empty()) return;  // stopping, and everything accepted is written
    Batch batch;
    while (!queue.empty() && batch.size() < largest_batch) {
      batch.push_back(queue.front());
      queue.pop_front();
    }
    lock.unlock();
    run_batch(batch);
    if (purge_wanted) clear_log();
    for (const auto& pending : batch) pending->over.release();
    lock.lock();
  }
}

void Database::run_batch(const Batch& batch) {
  try {
    log_rest();
    SQLite::Transaction transaction(*writer, SQLite::TransactionBehavior::IMMEDIATE);
    RowSeals changed;
    for (const auto& pending : batch) {
      touched.clear();
      try {
        Savepoint savepoint(*writer);
        (*pending->change)(*writer);
        savepoint.release();
        changed.merge(touched);
      } catch (...) {
        // SQLite gives the whole transaction up on a full disk: no change is kept then.
        if (sqlite3_get_autocommit(writer->getHandle()) != 0) throw;
        pending->failure = std::current_exception();
      }
    }
    auto rows = unlogged;
    if (!changed.empty()) rows = enter_ledger(changed);
    transaction.commit();
    if (!changed.empty()) ++commits;
    unlogged = std::move(rows);
    log_rest();
  } catch (...) {
    for (const auto& pending : batch)
      if (!pending->failure) pending->failure = std::current_exception();
  }
}

RowSeals Database::enter_ledger(const RowSeals& changed) {
  auto rows = unlogged;
  for (const auto& [name, ignored] : changed) {
    auto seal = writer->query("SELECT seal FROM main." + name.first + " WHERE rowid = ?");
    seal->bind(1, name.second);
    rows[name] = seal->executeStep() ? seal->getColumn(0).getString() : "";
  }
  auto update =
      writer->query("UPDATE ledger SET commits = ?, logged = ?, unlogged = ? WHERE id = 1");
  update->bind(1, static_cast<std::int64_t>(commits + 1));
  update->bind(2, static_cast<std::int64_t>(logged));
  update->bind(3, text_of(rows));
  update->exec();
  return rows;
}

/// Nothing is acknowledged before the journal has it: a commit that could not be logged is logged
/// before the next one.
void Database::log_rest() {
  if (unlogged.empty()) return;
  journal->append(commits, text_of(unlogged));
  logged = commits;
  unlogged.clear();
}

void Database::clear_log() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_purge) return;
  try {
    writer->setBusyTimeout(purge_busy_ms);
    // The first column tells whether a reader kept a part of the log: then it is tried again.
    if (writer->execAndGet("PRAGMA wal_checkpoint(TRUNCATE)").getInt() == 0) {
      if (unlogged.empty()) journal->compact(journal->read());
      purge_wanted = !unlogged.empty();
    }
  } catch (const std::exception& error) {
    spdlog::warn("the write-ahead log cannot be cleared yet: {}", error.what());
  }
  writer->setBusyTimeout(busy_ms);
  next_purge = std::chrono::steady_clock::now() + purge_pause;
}

void Database::probe() {
  write([](SQLite::Database& connection) {
    const int version = connection.execAndGet("PRAGMA user_version").getInt();
    connection.exec("PRAGMA user_version = " + std::to_string(version));
  });
}

std::string Database::damage_text() const {
  const auto all = damage();
  if (all.empty()) return healthy() ? "" : "its structure is damaged";
  return text_of(all.front()) +
         (all.size() > 1 ? ", and " + std::to_string(all.size() - 1) + " more" : "");
}

std::vector<Damage> Database::damage() const {
  const std::lock_guard lock(damage_mutex);
  return damages;
}

void Database::report(const Damage& found) {
  damaged = true;
  const std::lock_guard lock(damage_mutex);
  if (std::find(damages.begin(), damages.end(), found) != damages.end()) return;
  damages.push_back(found);
  spdlog::error("damaged: {}", text_of(found));
}

void Database::prepare(SQLite::Database& connection) const {
  if (!seals) return;
  seals->add_function(connection);
  Seals::add_views(connection);
}

std::uint64_t Database::log_bytes() const {
  std::error_code failure;
  const auto bytes = std::filesystem::file_size(path.string() + "-wal", failure);
  return failure ? 0 : bytes;
}

}  // namespace penumbra::server::storage
