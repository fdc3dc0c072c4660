#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <semaphore>
#include <thread>
#include <vector>

#include "server/storage/connection.h"
#include "server/storage/examination.h"
#include "server/storage/journal.h"
#include "server/storage/readers.h"
#include "server/storage/seals.h"

namespace penumbra::server::storage {

/// The database of a data folder: one writing connection on one thread, and connections for
/// reading.
///
/// Writes that wait at the same time share one transaction, each in its own savepoint, so that many
/// people who answer at once pay for one sync of the disk and not for hundreds. `write` returns
/// after the commit: what it returned from is durable (WAL, synchronous=FULL).
///
/// Rows carry keyed digests, and a journal beside the database knows which rows there must be
/// (docs/decisions/0014-damage-is-seen.md). A write returns after both are on disk.
///
/// Failures become penumbra::Error: `busy` (locked too long), `storage` (disk full, input/output,
/// damage). After damage was seen, `healthy` is false and every write is refused.
class Database {
 public:
  /// Beside `file` lie integrity.key and answers.journal, which are made for a new database. What
  /// is damaged is opened for reading: see `healthy`.
  explicit Database(const std::filesystem::path& file);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Runs `work(Connection&)` in a transaction and returns what it returns; rolls its changes
  /// back where it throws.
  template <class Work>
  auto write(Work work) {
    using Result = decltype(work(std::declval<Connection&>()));
    if constexpr (std::is_void_v<Result>) {
      perform([&](Connection& connection) { work(connection); });
    } else {
      std::optional<Result> result;
      perform([&](Connection& connection) { result.emplace(work(connection)); });
      return std::move(*result);
    }
  }

  /// Runs `work(Connection&)` on a read-only connection, in a snapshot. There are a few
  /// connections: `work` must not read in turn.
  template <class Work>
  auto read(Work work) {
    return guarded([&] {
      Readers::Lease reader(readers);
      SQLite::Transaction snapshot(*reader);
      return work(*reader);
    });
  }

  /// From within a change: once it is committed, what it deleted also leaves the write-ahead log.
  void purge_log() { purge_wanted = true; }

  bool healthy() const { return !damaged.load(); }

  /// Writes without changing anything. Throws as `write` does.
  void probe();

  /// Why it is not healthy; empty where it is.
  std::string damage_text() const;
  /// What was found damaged, at the start or since.
  std::vector<Damage> damage() const;
  /// Notes damage that a reader met.
  void report(const Damage& found);

  /// Failures of the database that were no fault of the call: full disk, lock, input/output.
  std::uint64_t failures() const { return failure_count.load(); }

  /// Length of the write-ahead log.
  std::uint64_t log_bytes() const;

 private:
  using Change = std::function<void(Connection&)>;
  /// A change that waits. Shared, since the writer still touches `over` when its caller goes on.
  struct Pending {
    const Change* change = nullptr;
    std::exception_ptr failure;
    std::binary_semaphore over{0};
  };
  using Batch = std::vector<std::shared_ptr<Pending>>;

  void open_writer();
  bool holds_a_study() const;
  [[noreturn]] void refuse(const std::string& why);
  void check_rows();
  RowSeals enter_ledger(const RowSeals& changed);
  void log_rest();
  void prepare(SQLite::Database& connection) const;
  void perform(const Change& change);
  void run_writer();
  void run_batch(const Batch& batch);
  [[noreturn]] void translate(const SQLite::Exception& error);
  void clear_log();

  template <class Work>
  auto guarded(Work work) {
    try {
      return work();
    } catch (const SQLite::Exception& error) {
      translate(error);
    }
  }

  std::filesystem::path path;
  std::optional<Seals> seals;
  std::optional<Journal> journal;
  RowChanged note_row;        ///< of the triggers
  RowSeals touched;           ///< rows of the change at hand
  RowSeals unlogged;          ///< rows of commits that the journal lacks
  std::uint64_t commits = 0;  ///< as the ledger has it
  std::uint64_t logged = 0;   ///< the journal's last commit
  mutable std::mutex damage_mutex;
  std::vector<Damage> damages;
  std::atomic<bool> damaged{false};
  std::atomic<std::uint64_t> failure_count{0};
  std::atomic<bool> purge_wanted{false};
  std::unique_ptr<Connection> writer;  ///< used by the writer's thread only
  std::chrono::steady_clock::time_point next_purge{};
  std::mutex queue_mutex;
  std::condition_variable queue_changed;
  std::deque<std::shared_ptr<Pending>> queue;
  bool stopping = false;
  Readers readers;
  std::thread thread;
};

}  // namespace penumbra::server::storage
