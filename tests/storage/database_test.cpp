#include "server/storage/database.h"

#include <gtest/gtest.h>

#include <fstream>
#include <future>
#include <mutex>
#include <set>
#include <thread>

#include "renderer/error.h"
#include "tests/storage/folder.h"

namespace penumbra::server::storage {
namespace {

std::int64_t number(Database& database, const std::string& query) {
  return database.read(
      [&](SQLite::Database& connection) { return connection.execAndGet(query).getInt64(); });
}

void make_table(Database& database) {
  database.write([](SQLite::Database& connection) {
    connection.exec("CREATE TABLE numbers (value INTEGER PRIMARY KEY)");
  });
}

void insert(SQLite::Database& connection, int value) {
  connection.exec("INSERT INTO numbers VALUES (" + std::to_string(value) + ")");
}

class ADatabase : public testing::Test {
 protected:
  TemporaryFolder folder;
  std::filesystem::path file = folder.path / "penumbra.sqlite";
};

TEST_F(ADatabase, KeepsALogAndSyncsEveryCommit) {
  Database database(file);
  const auto mode = database.read([](SQLite::Database& connection) {
    return connection.execAndGet("PRAGMA journal_mode").getString();
  });
  EXPECT_EQ(mode, "wal");
  const auto full = database.write([](SQLite::Database& connection) {
    return connection.execAndGet("PRAGMA synchronous").getInt();
  });
  EXPECT_EQ(full, 2);  // FULL, as SQLite numbers it
}

TEST_F(ADatabase, TakesChangesFromManyThreadsAndLosesNone) {
  Database database(file);
  make_table(database);
  constexpr int people = 16;
  constexpr int each = 20;
  std::vector<std::future<void>> threads;
  for (int p = 0; p < people; ++p)
    threads.push_back(std::async(std::launch::async, [&, p] {
      for (int i = 0; i < each; ++i)
        database.write([&](SQLite::Database& connection) { insert(connection, p * each + i); });
    }));
  for (auto& thread : threads) thread.get();
  EXPECT_EQ(number(database, "SELECT COUNT(*) FROM numbers"), people * each);
}

TEST_F(ADatabase, RollsAFailedChangeBackAndKeepsItsNeighbours) {
  Database database(file);
  make_table(database);
  std::vector<std::future<bool>> changes;
  for (int i = 0; i < 32; ++i)
    changes.push_back(std::async(std::launch::async, [&, i] {
      try {
        database.write([&](SQLite::Database& connection) {
          insert(connection, i);
          if (i % 2 == 1) throw Error("conflict", "odd");
        });
        return true;
      } catch (const Error& error) {
        return error.code != "conflict";
      }
    }));
  for (int i = 0; i < 32; ++i) EXPECT_EQ(changes[static_cast<std::size_t>(i)].get(), i % 2 == 0);
  EXPECT_EQ(number(database, "SELECT COUNT(*) FROM numbers"), 16);
  EXPECT_EQ(number(database, "SELECT COUNT(*) FROM numbers WHERE value % 2 = 1"), 0);
}

TEST_F(ADatabase, HasCommittedWhatItReturnedFrom) {
  Database database(file);
  make_table(database);
  database.write([](SQLite::Database& connection) { insert(connection, 7); });
  SQLite::Database other(file.string(), SQLite::OPEN_READONLY);
  EXPECT_EQ(other.execAndGet("SELECT value FROM numbers").getInt(), 7);
}

TEST_F(ADatabase, CannotBeChangedByReaders) {
  Database database(file);
  make_table(database);
  EXPECT_THROW(database.read([](SQLite::Database& connection) {
    insert(connection, 1);
    return 0;
  }),
               Error);
  EXPECT_EQ(number(database, "SELECT COUNT(*) FROM numbers"), 0);
}

TEST_F(ADatabase, AnswersBusyWhenAnotherProgramHoldsItTooLong) {
  Database database(file);
  make_table(database);
  SQLite::Database other(file.string(), SQLite::OPEN_READWRITE);
  other.exec("BEGIN IMMEDIATE");
  try {
    database.write([](SQLite::Database& connection) { insert(connection, 1); });
    FAIL() << "wrote past a lock";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "busy");
  }
  other.exec("ROLLBACK");
  EXPECT_NO_THROW(database.write([](SQLite::Database& connection) { insert(connection, 1); }));
}

TEST_F(ADatabase, RecoversWhenADiskWasFull) {
  Database database(file);
  make_table(database);
  database.write(
      [](SQLite::Database& connection) { connection.exec("CREATE TABLE texts (value TEXT)"); });
  const auto pages = number(database, "PRAGMA page_count");
  database.write([&](SQLite::Database& connection) {
    connection.execAndGet("PRAGMA max_page_count = " + std::to_string(pages + 1));
  });
  try {
    database.write([](SQLite::Database& connection) {
      connection.exec("INSERT INTO texts VALUES (hex(zeroblob(100000)))");
    });
    FAIL() << "wrote more than there is room for";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "storage");
  }
  EXPECT_TRUE(database.healthy());
  EXPECT_EQ(number(database, "SELECT COUNT(*) FROM texts"), 0);
  EXPECT_NO_THROW(database.write([](SQLite::Database& connection) { insert(connection, 1); }));
}

TEST_F(ADatabase, RefusesToWriteWhenItIsDamaged) {
  {
    Database database(file);
    make_table(database);
    database.write([](SQLite::Database& connection) {
      for (int i = 0; i < 5000; ++i) insert(connection, i);
    });
  }
  {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(4096 * 3);
    bytes << std::string(static_cast<std::size_t>(4096 * 4), '\xff');
  }
  Database database(file);
  EXPECT_FALSE(database.healthy());
  try {
    database.write([](SQLite::Database& connection) { insert(connection, 5001); });
    FAIL() << "wrote into a damaged file";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "storage");
  }
}

TEST_F(ADatabase, LendsAFewConnectionsToManyReaders) {
  Database database(file);
  std::mutex mutex;
  std::set<sqlite3*> connections;
  std::vector<std::future<void>> readers;
  for (int i = 0; i < 64; ++i)
    readers.push_back(std::async(std::launch::async, [&] {
      for (int j = 0; j < 5; ++j)
        database.read([&](SQLite::Database& connection) {
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
          const std::lock_guard lock(mutex);
          connections.insert(connection.getHandle());
          return 0;
        });
    }));
  for (auto& reader : readers) reader.get();
  EXPECT_LE(connections.size(), 16u);
}

TEST_F(ADatabase, LendsAConnectionAgainWhenItsReaderFailed) {
  Database database(file);
  for (int i = 0; i < 40; ++i)
    EXPECT_THROW(database.read([](SQLite::Database&) -> int { throw Error("conflict", "no"); }),
                 Error);
  EXPECT_EQ(number(database, "SELECT 7"), 7);
}

TEST_F(ADatabase, IsNotTouchedByAnOlderProgram) {
  { Database database(file); }
  {
    SQLite::Database newer(file.string(), SQLite::OPEN_READWRITE);
    newer.exec("PRAGMA user_version = 9999");
  }
  EXPECT_THROW(Database{file}, Error);
}

TEST_F(ADatabase, IsReadableByItsOwnerOnly) {
  Database database(file);
  const auto permissions = std::filesystem::status(file).permissions();
  using std::filesystem::perms;
  EXPECT_EQ(permissions & (perms::group_all | perms::others_all), perms::none);
}

}  // namespace
}  // namespace penumbra::server::storage
