#include "server/storage/participants.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "renderer/error.h"
#include "server/storage/data_folder.h"
#include "server/storage/studies.h"
#include "study/enrolment.h"
#include "tests/storage/participation.h"

namespace penumbra::server::storage {
namespace {

using nlohmann::json;

std::string code_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code;
  }
  return "";
}

TEST_F(Participation, EnrolsTheSameEnrolmentOnce) {
  const auto first = enter("a");
  auto again = person("a");
  again.token = "another";
  again.withdrawal_code = "another";
  again.pseudonym = "another";
  EXPECT_EQ(participants.enrol(again, 0, "2026-01-01").token, first.token);
  EXPECT_EQ(count("SELECT COUNT(*) FROM participants"), 1);
}

TEST_F(Participation, StopsAtTheQuotaOfCompletedPeople) {
  const auto first = enter("a");
  answer(first, 0, "x", {});
  participants.complete(first, 1, json::object(), "2026-01-02");
  EXPECT_EQ(code_of([&] { participants.enrol(person("b"), 1, "2026-01-01"); }), "conflict");
  EXPECT_EQ(code_of([&] { participants.enrol(person("c"), 2, "2026-01-01"); }), "");
}

TEST_F(Participation, StoresAnAnswerOnceHoweverOftenItIsSent) {
  const auto who = enter("a");
  const auto first = answer(who, 0, "x", {{"shelf", 1}});
  EXPECT_EQ(answer(who, 0, "x", {{"shelf", 1}}), first);
  EXPECT_EQ(count("SELECT COUNT(*) FROM answers"), 1);
}

TEST_F(Participation, RefusesOtherContentOrAnotherPageUnderAKnownId) {
  const auto who = enter("a");
  answer(who, 0, "x", {{"shelf", 1}});
  EXPECT_EQ(code_of([&] { answer(who, 0, "x", {{"shelf", 2}}); }), "conflict");
  EXPECT_EQ(code_of([&] { answer(who, 1, "x", {{"shelf", 1}}); }), "conflict");
  EXPECT_EQ(participants.answers(who.key).at(0).body, json({{"shelf", 1}}));
}

TEST_F(Participation, ReplacesAnAnswerAndKeepsTheOldOne) {
  const auto who = enter("a");
  answer(who, 0, "x", {{"shelf", 1}});
  EXPECT_EQ(answer(who, 0, "y", {{"shelf", 2}}).at("replaced"), "x");
  ASSERT_EQ(participants.answers(who.key).size(), 1u);
  EXPECT_EQ(participants.answers(who.key)[0].answer_id, "y");
  EXPECT_EQ(count("SELECT COUNT(*) FROM answers"), 2);
}

TEST_F(Participation, DoesNotBringAReplacedAnswerBackWhenItIsSentAgain) {
  const auto who = enter("a");
  answer(who, 0, "x", {{"shelf", 1}});
  answer(who, 0, "y", {{"shelf", 2}});
  answer(who, 0, "x", {{"shelf", 1}});
  EXPECT_EQ(participants.answers(who.key).at(0).answer_id, "y");
}

TEST_F(Participation, HasOneCurrentAnswerAfterARaceOfTabs) {
  const auto who = enter("a");
  std::vector<std::future<json>> tabs;
  for (int i = 0; i < 20; ++i)
    tabs.push_back(std::async(std::launch::async, [&, i] {
      return answer(who, 0, std::to_string(i), {{"n", i}});
    }));
  for (auto& tab : tabs) tab.get();
  EXPECT_EQ(count("SELECT COUNT(*) FROM answers"), 20);
  EXPECT_EQ(count("SELECT COUNT(*) FROM answers WHERE is_current = 1"), 1);
}

TEST_F(Participation, CompletesOnlyWithEveryPageAnswered) {
  const auto who = enter("a");
  answer(who, 0, "x", {});
  EXPECT_EQ(code_of([&] { participants.complete(who, 2, json::object(), "2026-01-04"); }),
            "conflict");
  EXPECT_TRUE(participants.find("token-a")->completed_at.empty());
  answer(who, 1, "y", {});
  participants.complete(who, 2, {{"comment", "fine"}}, "2026-01-04");
  EXPECT_EQ(participants.find("token-a")->completed_at, "2026-01-04");
  EXPECT_EQ(code_of([&] { answer(who, 1, "z", {}); }), "conflict");
  EXPECT_EQ(answer(who, 1, "y", {}).at("id"), "y");
}

TEST_F(Participation, ClosedStudiesTakeNobodyAndNothing) {
  const auto who = enter("a");
  studies.close("s", "2026-01-05");
  EXPECT_EQ(code_of([&] { enter("b"); }), "conflict");
  EXPECT_EQ(code_of([&] { answer(who, 0, "x", {}); }), "");  // amid it, and not closed long enough
  studies.reopen("s", 1);
  studies.close("s", "2026-01-04");
  EXPECT_EQ(code_of([&] { answer(who, 1, "y", {}); }), "conflict");
  EXPECT_EQ(answer(who, 0, "x", {}).at("id"), "x");
}

TEST_F(Participation, WithdrawalLeavesNoTrace) {
  const auto who = enter("a");
  answer(who, 0, "x", {{"secret", "needle-in-the-file"}});
  participants.exclude("s", "p-a", {true, "test", "2026-01-03"});
  EXPECT_FALSE(participants.withdraw("code-b", "2026-01-04"));
  EXPECT_TRUE(participants.withdraw("code-a", "2026-01-04"));
  EXPECT_FALSE(participants.withdraw("code-a", "2026-01-04"));
  EXPECT_FALSE(participants.find("token-a").has_value());
  EXPECT_EQ(count("SELECT COUNT(*) FROM answers"), 0);
  EXPECT_EQ(count("SELECT COUNT(*) FROM exclusions"), 0);
  for (const char* file : {"db", "db-wal"})
    EXPECT_EQ(read_file(folder.path / file).find("needle-in-the-file"), std::string::npos) << file;
  EXPECT_EQ(studies.counts("s", 1).withdrawn, 1);
  EXPECT_EQ(studies.counts("s", 1).entered, 0);
}

TEST_F(Participation, WithdrawalUnderAReaderIsQuickAndLeavesNoTraceOnceTheReaderLeft) {
  const auto who = enter("a");
  const auto other = enter("b");
  answer(who, 0, "x", {{"secret", "needle-in-the-file"}});
  {
    SQLite::Database outside((folder.path / "db").string(), SQLite::OPEN_READONLY);
    SQLite::Transaction snapshot(outside);
    outside.execAndGet("SELECT COUNT(*) FROM answers");
    const auto start = std::chrono::steady_clock::now();
    EXPECT_TRUE(participants.withdraw("code-a", "2026-01-04"));
    answer(other, 0, "y", {{"shelf", 1}});
    // Waiting for the reader would take the 3 s that a lock is waited for.
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(2900));
  }
  const auto left = [&] {
    for (const auto& entry : std::filesystem::directory_iterator(folder.path))
      if (read_file(entry.path()).find("needle-in-the-file") != std::string::npos) return true;
    return false;
  };
  for (int i = 0; i < 50 && left(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_FALSE(left());
  EXPECT_EQ(participants.answers(other.key).size(), 1u);
}

TEST_F(Participation, LetsPeopleFinishAVersionThatTheNextOneReplaced) {
  const auto who = enter("a");
  studies.put_draft("s", {{"id", "s"}, {"changed", true}}, 43, "2026-01-06");
  studies.start_publishing("s", 2, "other", 0);
  studies.open("s", 2, "2026-01-07");
  EXPECT_EQ(code_of([&] { answer(who, 0, "x", {}); }), "");
  participants.complete(who, 1, json::object(), "2026-01-07");
  EXPECT_EQ(code_of([&] { enter("b"); }), "conflict");  // of version 1, which takes no one new
}

TEST_F(Participation, TestsTakeNoPlaceAndAreNotCounted) {
  auto test = person("t");
  test.test = true;
  participants.enrol(test, 0, "2026-01-01");
  EXPECT_EQ(enter("a").place, 0u);
  EXPECT_EQ(studies.counts("s", 1).entered, 1);
  EXPECT_EQ(studies.counts("s", 1).tests, 1);
}

TEST_F(Participation, ExclusionsCanBeTakenBackAndAreRemembered) {
  enter("a");
  EXPECT_TRUE(participants.exclude("s", "p-a", {true, "inverted", "2026-01-03"}));
  EXPECT_TRUE(participants.exclude("s", "p-a", {false, "asked", "2026-01-04"}));
  EXPECT_FALSE(participants.exclude("s", "p-z", {true, "", "2026-01-04"}));
  participants.each("s", 1, [](const ParticipantData& data) {
    EXPECT_FALSE(data.excluded());
    ASSERT_EQ(data.exclusions.size(), 2u);
    EXPECT_EQ(data.exclusions[0].reason, "inverted");
  });
}

TEST_F(Participation, EachVisitsEverybodyInOrderOfEntry) {
  for (int i = 0; i < 450; ++i) enter(std::to_string(i));
  int expected = 0;
  participants.each("s", 1, [&](const ParticipantData& data) {
    EXPECT_EQ(data.participant.pseudonym, "p-" + std::to_string(expected++));
  });
  EXPECT_EQ(expected, 450);
}

TEST_F(Participation, TextIsStoredAsItIs) {
  const auto who = enter("a");
  const json body = {{"text", "'); DROP TABLE answers; --"}};
  answer(who, 0, "x", body);
  EXPECT_EQ(participants.answers(who.key).at(0).body, body);
}

TEST_F(Participation, AChangedDocumentBecomesANewVersion) {
  const auto second = studies.put_draft("s", {{"id", "s"}, {"changed", true}}, 43, "2026-01-06");
  EXPECT_EQ(second.version, 2);
  EXPECT_EQ(studies.open_version("s")->version, 1);
  EXPECT_EQ(studies.put_draft("s", {{"id", "s"}}, 44, "2026-01-06").version, 1);  // as published
  EXPECT_EQ(studies.current("s")->version, 1);
  EXPECT_EQ(studies.draft("s")->version, 2);
  studies.start_publishing("s", 2, "other", 0);
  studies.open("s", 2, "2026-01-07");
  EXPECT_EQ(studies.find("s", 1)->status, "closed");
  EXPECT_EQ(studies.open_version("s")->hash, "other");
  EXPECT_EQ(code_of([&] { studies.start_publishing("s", 2, "h", 0); }), "conflict");
}

}  // namespace
}  // namespace penumbra::server::storage
