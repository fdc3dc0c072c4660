// Bytes of the database that are not what was stored: always told, never exported as if right.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <random>
#include <set>

#include "renderer/error.h"
#include "server/storage/backup.h"
#include "server/storage/data_folder.h"
#include "server/storage/migrate.h"
#include "tests/storage/damaged.h"

namespace penumbra::server::storage {
namespace {

TEST_F(Damaged, NothingIsWhenNothingWasChanged) {
  fill(5, 6);
  Store store(data);
  EXPECT_TRUE(store.database.healthy()) << store.database.damage_text();
  EXPECT_TRUE(verify_folder(data).empty());
}

TEST_F(Damaged, OneDigitOfAnAnswerIsToldByPseudonymAndTheRestIsExported) {
  fill(3, 4);
  change("UPDATE answers SET body = replace(body, '2', '3') WHERE answer_id = 'p-1-1-2'");
  Store store(data);
  EXPECT_FALSE(store.database.healthy());
  const auto damage = store.database.damage();
  ASSERT_EQ(damage.size(), 1u);
  EXPECT_EQ(damage[0].table, "answers");
  EXPECT_EQ(damage[0].participant, "p-1");
  int answers = 0;
  store.participants.each("s", 1, [&](const ParticipantData& person) {
    answers += static_cast<int>(person.answers.size());
  });
  EXPECT_EQ(answers, 11);
  EXPECT_EQ(code_of([&] { enter(store, "new"); }), "storage");
  EXPECT_EQ(verify_folder(data).size(), 1u);
}

TEST_F(Damaged, EveryTableThatFeedsAnExportIsGuarded) {
  fill(2, 2);
  {
    Store store(data);
    store.participants.exclude("s", "p-0", {true, "why", "2026-01-04"});
    store.participants.withdraw("code-1", "2026-01-05");
  }
  for (const std::string sql :
       {"UPDATE studies SET seed = 43", "UPDATE participants SET place = 7",
        "UPDATE participants SET completed_at = 'x'", "DELETE FROM exclusions",
        "UPDATE exclusions SET excluded = 0", "DELETE FROM withdrawals",
        "UPDATE answers SET page = page + 5", "DELETE FROM answers WHERE page = 1",
        "DELETE FROM participants", "UPDATE ledger SET commits = commits + 1",
        "INSERT INTO withdrawals (study, version, withdrawn_at) VALUES ('s', 1, '')"}) {
    const TemporaryFolder other;
    fs::copy(data, other.path / "data", fs::copy_options::recursive);
    SQLite::Database behind((other.path / "data" / "penumbra.sqlite").string(),
                            SQLite::OPEN_READWRITE);
    behind.exec(sql);
    EXPECT_FALSE(Store(other.path / "data").database.healthy()) << sql;
  }
}

TEST_F(Damaged, ARowThatIsDamagedMeanwhileIsNotSealedAnew) {
  fill(2, 2);
  Store store(data);
  change("UPDATE answers SET body = '{\"difficulty\":5}' WHERE answer_id = 'p-0-0-1'");
  const auto who = *store.participants.find("token-0");
  EXPECT_EQ(code_of([&] { answer(store, who, 0, 4); }), "storage");
  EXPECT_FALSE(store.database.healthy());
}

TEST_F(Damaged, FlippedBitsNeverGiveAnotherExportFromAServerThatIsReady) {
  fill(12, 9);
  std::string right;
  {
    Store store(data);
    right = exported(store);
  }
  const auto bytes = read_file(file());
  std::mt19937 random(7);
  int noticed = 0;
  const auto with_flips = [&](int flips) {
    auto damaged = bytes;
    for (int i = 0; i < flips; ++i)
      damaged[random() % damaged.size()] ^= static_cast<char>(1u << (random() % 8));
    write_file_durably(file(), damaged);
    for (const char* tail : {"-wal", "-shm"}) fs::remove(file().string() + tail);
    try {
      Store store(data);
      const auto text = exported(store);
      const bool ready = store.database.healthy();
      if (!ready) ++noticed;
      EXPECT_TRUE(!ready || text == right);
    } catch (const Error&) {
      ++noticed;
    }
  };
  for (int i = 0; i < 200; ++i) with_flips(1);
  const int of_single = noticed;
  for (int i = 0; i < 40; ++i) with_flips(8);
  RecordProperty("noticed", noticed);
  EXPECT_GT(of_single, 10);  // the others hit bytes that hold nothing
}

TEST_F(Damaged, AcknowledgedAnswersThatTheLogLostAreMissed) {
  fill(1, 1);
  const pid_t child = ::fork();
  if (child == 0) {
    Store store(data);
    for (int i = 0; i < 30; ++i) {
      const auto who = enter(store, "late" + std::to_string(i));
      answer(store, who, 0, 3);
    }
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const auto log = file().string() + "-wal";
  ASSERT_GT(fs::file_size(log), 100000u);
  {
    const TemporaryFolder sound;
    fs::copy(data, sound.path / "data", fs::copy_options::recursive);
    Store store(sound.path / "data");
    EXPECT_TRUE(store.database.healthy()) << store.database.damage_text();
    EXPECT_TRUE(store.participants.find("token-late29"));
  }
  {
    std::fstream changed(log, std::ios::in | std::ios::out | std::ios::binary);
    changed.seekp(static_cast<std::streamoff>(fs::file_size(log) / 2));
    changed.put('\x5a');
    changed.put('\xa5');
  }
  Store store(data);
  EXPECT_FALSE(store.database.healthy());
  EXPECT_NE(store.database.damage_text().find("acknowledged"), std::string::npos)
      << store.database.damage_text();
}

TEST_F(Damaged, AnEmptyDatabaseBesideAStudyIsRefused) {
  fill(1, 1);
  for (const bool removed : {false, true}) {
    for (const char* tail : {"-wal", "-shm"}) fs::remove(file().string() + tail);
    fs::resize_file(file(), 0);
    if (removed) fs::remove(file());
    Store store(data);
    EXPECT_FALSE(store.database.healthy());
    EXPECT_EQ(code_of([&] { store.participants.find("token-0"); }), "storage");
    EXPECT_EQ(code_of([&] { enter(store, "x"); }), "storage");
    EXPECT_TRUE(removed || fs::file_size(file()) == 0u);
  }
}

TEST_F(Damaged, AMissingOrAlteredKeyOrJournalIsTold) {
  fill(2, 2);
  for (const std::string name : {"integrity.key", "answers.journal"}) {
    for (const bool removed : {true, false}) {
      const TemporaryFolder other;
      fs::copy(data, other.path / "data", fs::copy_options::recursive);
      const auto victim = other.path / "data" / name;
      if (removed) {
        fs::remove(victim);
      } else {
        auto bytes = read_file(victim);
        bytes[bytes.size() / 3] ^= 4;
        write_file_durably(victim, bytes);
      }
      EXPECT_FALSE(Store(other.path / "data").database.healthy()) << name << removed;
      EXPECT_FALSE(verify_folder(other.path / "data").empty()) << name << removed;
    }
  }
}

TEST_F(Damaged, AJournalLineThatWasCutOffIsMadeUpFor) {
  fill(1, 2);
  const auto journal = data / "answers.journal";
  fs::resize_file(journal, fs::file_size(journal) - 20);
  {
    Store store(data);
    EXPECT_TRUE(store.database.healthy()) << store.database.damage_text();
    enter(store, "next");
  }
  EXPECT_TRUE(Store(data).database.healthy());
}

TEST_F(Damaged, TheJournalForgetsWhoWithdrew) {
  fill(2, 2);
  Store store(data);
  store.participants.withdraw("code-0", "2026-01-05");
  const auto journal = [&] { return read_file(data / "answers.journal"); };
  for (int i = 0; i < 50 && journal().find("participants 1 ") != std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(journal().find("participants 1 "), std::string::npos);
  EXPECT_NE(journal().find("participants 2 "), std::string::npos);
}

TEST_F(Damaged, ADataFolderOfAnEarlierVersionIsSealedOnce) {
  fs::remove_all(data);
  make_private_folder(data);
  {
    SQLite::Database old(file().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    for (const auto& migration : migrations())
      if (migration.path < "schema/migrations/0004") old.exec(std::string(migration.text));
    old.exec("PRAGMA user_version = 3");
    old.exec(
        "INSERT INTO studies (study, version, status, document, seed, created_at) "
        "VALUES ('old', 1, 'draft', '{}', 5, 'then')");
  }
  {
    Store store(data);
    EXPECT_TRUE(store.database.healthy()) << store.database.damage_text();
    EXPECT_EQ(store.studies.current("old")->seed, 5u);
  }
  change("UPDATE studies SET seed = 6");
  EXPECT_FALSE(Store(data).database.healthy());
}

TEST_F(Damaged, ABackupUnderLoadIsRestoredWhole) {
  fill(3, 3);
  Store store(data);
  std::atomic<bool> stop{false};
  std::thread load([&] {
    for (int i = 0; !stop && i < 2000; ++i) {
      const auto who = enter(store, "load" + std::to_string(i));
      answer(store, who, 0, 2);
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const auto before = exported(store);
  const auto backup = folder.path / "backup.zip";
  EXPECT_EQ(code_of([&] { back_up(data, backup); }), "");
  stop = true;
  load.join();
  ASSERT_TRUE(fs::exists(backup));
  EXPECT_EQ(static_cast<unsigned>(fs::status(backup).permissions()) & 0777u, 0600u);
  restore(backup, folder.path / "restored");
  EXPECT_EQ(verify_folder(folder.path / "restored"), std::vector<std::string>{});
  Store restored(folder.path / "restored");
  EXPECT_TRUE(restored.database.healthy()) << restored.database.damage_text();
  const auto text = exported(restored);
  EXPECT_EQ(text.substr(0, before.size()), before);  // in order of entry: all that was there
  EXPECT_EQ(code_of([&] { restore(backup, folder.path / "restored"); }), "conflict");
}

TEST_F(Damaged, ABackupThatWasAlteredIsNotRestored) {
  fill(1, 1);
  const auto backup = folder.path / "backup.zip";
  back_up(data, backup);
  auto bytes = read_file(backup);
  bytes[bytes.size() / 2] ^= 1;
  write_file_durably(backup, bytes);
  EXPECT_NE(code_of([&] { restore(backup, folder.path / "restored"); }), "");
}

TEST_F(Damaged, ADamagedFolderIsNotBackedUp) {
  fill(1, 1);
  change("UPDATE answers SET page = 9");
  EXPECT_EQ(code_of([&] { back_up(data, folder.path / "backup.zip"); }), "storage");
  EXPECT_FALSE(fs::exists(folder.path / "backup.zip"));
}

}  // namespace
}  // namespace penumbra::server::storage
