#include "server/storage/database.h"

#include <spdlog/spdlog.h>
#include <sqlite3.h>

#include <algorithm>
#include <charconv>

#include "renderer/error.h"
#include "server/storage/data_folder.h"

namespace penumbra::server::storage {
namespace {

constexpr int busy_ms = 3000;  // a lock held longer than this is somebody else's trouble
constexpr std::size_t largest_batch = 64;  // changes that share one commit
constexpr int purge_busy_ms = 20;          // answers wait no longer for a withdrawal to be cleared
constexpr auto purge_pause = std::chrono::milliseconds(250);
constexpr std::int64_t log_limit = 4
                                   << 20;  // bytes that the write-ahead log keeps when it is reset

int number_of(const EmbeddedFile& file) {
  const auto name = file.path.substr(file.path.rfind('/') + 1);
  int number = 0;
  std::from_chars(name.data(), name.data() + name.size(), number);
  return number;
}

constexpr int first_with_seals = 4;  // migration that added them

void seal_first_time(SQLite::Database& connection) {
  Seals::seal_all(connection);
  SQLite::Statement rows(connection, "UPDATE ledger SET unlogged = ?");
  rows.bind(1, text_of(seals_of(connection)));
  rows.exec();
  Seals::seal_all(connection);
}

/// Brings the tables to the newest version; a database of a newer program is refused.
void migrate(SQLite::Database& connection) {
  std::vector<EmbeddedFile> files(migrations().begin(), migrations().end());
  std::sort(files.begin(), files.end(),
            [](const auto& a, const auto& b) { return a.path < b.path; });
  const int present = connection.execAndGet("PRAGMA user_version").getInt();
  const int newest = files.empty() ? 0 : number_of(files.back());
  if (present > newest)
    throw Error("storage", "the data folder was written by a newer version of the program", "data");
  for (const auto& file : files) {
    if (number_of(file) <= present) continue;
    SQLite::Transaction transaction(connection, SQLite::TransactionBehavior::IMMEDIATE);
    connection.exec(std::string(file.text));
    // Rows from before there were seals; a later file that changes rows seals those it changed.
    if (number_of(file) == first_with_seals) seal_first_time(connection);
    connection.exec("PRAGMA user_version = " + std::to_string(number_of(file)));
    transaction.commit();
  }
}

}  // namespace

Database::Database(const std::filesystem::path& file) : path(file) {
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
  const auto pictures = path.parent_path() / "pictures";
  return std::filesystem::is_directory(pictures, failure) &&
         !std::filesystem::is_empty(pictures, failure);
}

void Database::refuse(const std::string& why) {
  report({"database", 0, "", why});
  throw Error("storage", why, "data");
}

void Database::open_writer() {
  const auto key_file = path.parent_path() / "integrity.key";
  const auto journal_file = path.parent_path() / "answers.journal";
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

  writer = std::make_unique<SQLite::Database>(
      path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, busy_ms);
  std::filesystem::permissions(
      path, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  writer->exec("PRAGMA journal_mode = WAL");
  writer->exec("PRAGMA synchronous = FULL");
  writer->exec("PRAGMA foreign_keys = ON");
  writer->exec("PRAGMA secure_delete = ON");  // who withdraws leaves no bytes behind
  writer->exec("PRAGMA journal_size_limit = " + std::to_string(log_limit));
  if (writer->execAndGet("PRAGMA integrity_check").getString() != "ok")
    refuse("its structure is damaged");

  const bool sealed = writer->execAndGet("PRAGMA user_version").getInt() >= first_with_seals;
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
  Pending pending{&change, nullptr};
  std::unique_lock lock(queue_mutex);
  if (stopping) throw Error("draining", "the server is stopping");
  queue.push_back(&pending);
  queue_changed.notify_one();
  batch_over.wait(lock, [&] { return pending.over; });
  lock.unlock();
  if (pending.failure) guarded([&] { std::rethrow_exception(pending.failure); });
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
    std::vector<Pending*> batch;
    while (!queue.empty() && batch.size() < largest_batch) {
      batch.push_back(queue.front());
      queue.pop_front();
    }
    lock.unlock();
    run_batch(batch);
    if (purge_wanted) clear_log();
    lock.lock();
    for (auto* pending : batch) pending->over = true;
    batch_over.notify_all();
  }
}

void Database::run_batch(const std::vector<Pending*>& batch) {
  try {
    log_rest();
    SQLite::Transaction transaction(*writer, SQLite::TransactionBehavior::IMMEDIATE);
    touched.clear();
    for (auto* pending : batch) {
      const auto before = touched;
      try {
        SQLite::Savepoint savepoint(*writer, "change");
        (*pending->change)(*writer);
        savepoint.release();
      } catch (...) {
        // SQLite gives the whole transaction up on a full disk: nobody's change stands then.
        if (sqlite3_get_autocommit(writer->getHandle()) != 0) throw;
        pending->failure = std::current_exception();
        touched = before;
      }
    }
    auto rows = unlogged;
    if (!touched.empty()) rows = enter_ledger();
    transaction.commit();
    if (!touched.empty()) ++commits;
    unlogged = std::move(rows);
    log_rest();
  } catch (...) {
    for (auto* pending : batch)
      if (!pending->failure) pending->failure = std::current_exception();
  }
}

RowSeals Database::enter_ledger() {
  auto rows = unlogged;
  for (const auto& [name, ignored] : touched) {
    SQLite::Statement query(*writer, "SELECT seal FROM main." + name.first + " WHERE rowid = ?");
    query.bind(1, name.second);
    rows[name] = query.executeStep() ? query.getColumn(0).getString() : "";
  }
  SQLite::Statement update(*writer,
                           "UPDATE ledger SET commits = ?, logged = ?, unlogged = ? WHERE id = 1");
  update.bind(1, static_cast<std::int64_t>(commits + 1));
  update.bind(2, static_cast<std::int64_t>(logged));
  update.bind(3, text_of(rows));
  update.exec();
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

Database::Lease::Lease(Database& owner_) : owner(owner_) {
  {
    std::lock_guard lock(owner.readers_mutex);
    if (!owner.readers.empty()) {
      connection = std::move(owner.readers.back());
      owner.readers.pop_back();
    }
  }
  if (!connection)
    owner.guarded([&] {
      connection =
          std::make_unique<SQLite::Database>(owner.path.string(), SQLite::OPEN_READONLY, busy_ms);
      owner.prepare(*connection);
    });
}

Database::Lease::~Lease() {
  constexpr std::size_t kept = 16;
  std::lock_guard lock(owner.readers_mutex);
  if (owner.readers.size() < kept) owner.readers.push_back(std::move(connection));
}

}  // namespace penumbra::server::storage
