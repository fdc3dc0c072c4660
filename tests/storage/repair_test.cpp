// A data folder that verify finds damaged is made sound, and nothing of it is lost.
#include "server/storage/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "server/storage/backup.h"
#include "server/storage/folder_files.h"
#include "tests/storage/damaged.h"

namespace penumbra::server::storage {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Repaired : public Damaged {
 protected:
  std::string now() {
    Store store(data);
    EXPECT_TRUE(store.database.healthy()) << store.database.damage_text();
    return exported(store);
  }

  Repair repair() {
    auto done = repair_folder(data);
    EXPECT_THAT(verify_folder(data), IsEmpty());
    return done;
  }

  /// The documents of rows.jsonl.
  static std::vector<json> rows_aside(const Repair& repair) {
    std::vector<json> rows;
    std::istringstream lines(read_file(repair.folder / "rows.jsonl"));
    for (std::string line; std::getline(lines, line);) rows.push_back(json::parse(line));
    return rows;
  }

  static std::set<std::string> lines_of(const std::string& text) {
    std::set<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.insert(line);
    return lines;
  }
};

TEST_F(Repaired, ASoundFolderIsLeftAsItIs) {
  fill(2, 2);
  const auto before = read_file(file());
  const auto done = repair_folder(data);
  EXPECT_THAT(done.found, IsEmpty());
  EXPECT_TRUE(done.folder.empty());
  EXPECT_EQ(read_file(file()), before);
}

TEST_F(Repaired, AnAlteredAnswerGoesAsideWithItsValuesAndTheRestStays) {
  fill(3, 2);
  const auto right = now();
  change("UPDATE answers SET body = '{\"difficulty\":9}' WHERE participant = 2 AND page = 1");
  const auto altered = read_file(file());
  const auto done = repair();
  const auto rows = rows_aside(done);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0]["table"], "answers");
  EXPECT_EQ(rows[0]["values"]["body"], "{\"difficulty\":9}");
  // As many lines as before but that one, all of them as they were.
  const auto before = lines_of(right);
  const auto after = lines_of(now());
  EXPECT_EQ(after.size(), before.size() - 1);
  EXPECT_TRUE(std::includes(before.begin(), before.end(), after.begin(), after.end()));
  EXPECT_EQ(read_file(done.folder / database_name), altered);
}

TEST_F(Repaired, WhatBelongsToADamagedPersonGoesAsideWithThem) {
  fill(3, 2);
  change("UPDATE participants SET place = 77 WHERE id = 2");
  const auto rows = rows_aside(repair());
  EXPECT_EQ(rows.size(), 3u);  // the person and two answers
  for (const auto& row : rows)
    EXPECT_EQ(row["table"] == "participants" ? row["row"] : row["values"]["participant"], 2);
  EXPECT_THAT(now(), Not(HasSubstr("p-1 ")));
  EXPECT_THAT(now(), HasSubstr("p-0 "));
  EXPECT_THAT(now(), HasSubstr("p-2 "));
}

TEST_F(Repaired, RowsOfOtherPagesSurviveARuinedOne) {
  fill(60, 9);
  const auto right = lines_of(now());
  // A page of answers in the middle of the file.
  auto bytes = read_file(file());
  const auto at = bytes.find("p-30-4-5{") / 4096 * 4096;
  ASSERT_LT(at, bytes.size());
  bytes.replace(at, 4096, std::string(4096, '\xff'));
  write_file_durably(file(), bytes);
  const auto done = repair();
  const auto kept = lines_of(now());
  EXPECT_TRUE(std::includes(right.begin(), right.end(), kept.begin(), kept.end()));
  EXPECT_GT(kept.size(), right.size() / 2);
  EXPECT_LT(kept.size(), right.size());
  // What was lost is named: every row of before is kept or told of.
  EXPECT_GE(kept.size() + done.aside.size(), right.size());
}

TEST_F(Repaired, JournalAndKeyAreMadeAnew) {
  fill(3, 2);
  const auto right = now();
  const auto with = [&](const char* what, const std::function<void()>& damage) {
    damage();
    EXPECT_THAT(verify_folder(data), Not(IsEmpty())) << what;
    repair();
    EXPECT_EQ(now(), right) << what;
    Store store(data);  // and takes what comes
    enter(store, what);
    EXPECT_TRUE(store.participants.withdraw(std::string("code-") + what, "2026-01-09"));
  };
  with("no-journal", [&] { fs::remove(data / journal_name); });
  with("altered-journal", [&] {
    auto bytes = read_file(data / journal_name);
    bytes[5] ^= 1;
    write_file_durably(data / journal_name, bytes);
  });
  with("no-key", [&] { fs::remove(data / key_name); });
  with("another-key", [&] { write_file_durably(data / key_name, std::string(32, 'k')); });
  with("open-to-others",
       [&] { fs::permissions(file(), fs::perms::others_read, fs::perm_options::add); });
}

TEST_F(Repaired, WhoWithdrewDoesNotComeBackWithAnOldDatabase) {
  fill(2, 1);
  const auto old = read_file(file());
  {
    Store store(data);
    EXPECT_TRUE(store.participants.withdraw("code-1", "2026-01-09"));
    answer(store, *store.participants.find("token-0"), 0, 5);
  }
  write_file_durably(file(), old);
  const auto done = repair();
  EXPECT_THAT(now(), Not(HasSubstr("p-1")));
  EXPECT_THAT(now(), HasSubstr("p-0"));
  // The answer that the old file lacks is named.
  EXPECT_THAT(done.aside, testing::Contains(HasSubstr("acknowledged and is missing")));
}

TEST_F(Repaired, AnAlteredPictureIsMovedAsideAndToBeDrawn) {
  make_private_folder(data / pictures_name);
  const std::string digest(64, 'a');
  {
    Store store(data);
    store.studies.put_draft("t", {{"id", "t"}}, 1, "2026-01-01");
    store.studies.start_publishing("t", 1, "hash", 1);
    store.studies.count_picture("t", 1, "request", {"render", digest});
  }
  write_file_durably(data / pictures_name / (digest + ".png"), "altered");
  const auto done = repair_folder(data);
  EXPECT_THAT(done.pictures, testing::ElementsAre(digest));
  EXPECT_EQ(read_file(done.folder / pictures_name / (digest + ".png")), "altered");
}

TEST_F(Repaired, WhatCannotBeReadAtAllStaysAsItIs) {
  fill(2, 1);
  const std::string noise(20000, '\x5a');
  write_file_durably(file(), noise);
  EXPECT_EQ(code_of([&] { repair_folder(data); }), "storage");
  EXPECT_EQ(read_file(file()), noise);
  EXPECT_FALSE(Store(data).database.healthy());
}

TEST_F(Repaired, NotWhileAServerRunsOnIt) {
  fill(1, 1);
  change("UPDATE answers SET page = 5");
  const DataFolder owned(data);
  EXPECT_EQ(code_of([&] { repair_folder(data); }), "conflict");
}

}  // namespace
}  // namespace penumbra::server::storage
