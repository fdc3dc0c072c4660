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
#include "tests/storage/folder.h"

namespace penumbra::server::storage {
namespace {

using nlohmann::json;

class Participation : public testing::Test {
 protected:
  Participation() {
    studies.put_draft("s", {{"id", "s"}}, 42, "2026-01-01");
    studies.start_publishing("s", 1, "hash", 0);
    studies.open("s", 1, "2026-01-01");
  }

  static ParticipantRecord person(const std::string& name,
                                  const std::string& entered = "2026-01-02") {
    ParticipantRecord record;
    record.pseudonym = "p-" + name;
    record.study = "s";
    record.token = "token-" + name;
    record.withdrawal_code = "code-" + name;
    record.enrolment_id = "enrolment-" + name;
    record.language = "en";
    record.entered_at = entered;
    return record;
  }

  ParticipantRecord enter(const std::string& name, const std::string& entered = "2026-01-02") {
    return participants.enrol(person(name, entered), 0, "2026-01-01");
  }

  json answer(const ParticipantRecord& who, int page, const std::string& id, const json& body) {
    return participants.answer(
        who, {page, id, body, "2026-01-03"}, [&](const json& stored) { return stored == body; },
        [&](const std::string& replaced, int answered) {
          return json{{"id", id}, {"replaced", replaced}, {"answered", answered}};
        },
        "2026-01-05");
  }

  std::int64_t count(const std::string& query) {
    return database.read(
        [&](SQLite::Database& connection) { return connection.execAndGet(query).getInt64(); });
  }

  TemporaryFolder folder;
  Database database{folder.path / "db"};
  Studies studies{database};
  Participants participants{database};
};

std::string code_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code;
  }
  return "";
}

TEST_F(Participation, GivesEveryPersonAPlaceOfTheirOwn) {
  std::vector<std::future<std::size_t>> entries;
  for (int i = 0; i < 40; ++i)
    entries.push_back(
        std::async(std::launch::async, [this, i] { return enter(std::to_string(i)).place; }));
  std::set<std::size_t> places;
  for (auto& entry : entries) places.insert(entry.get());
  EXPECT_EQ(places.size(), 40u);
  EXPECT_EQ(*places.rbegin(), 39u);
}

TEST_F(Participation, GivesAnAbandonedPlaceToTheNextPerson) {
  enter("early", "2026-01-02");
  enter("busy", "2026-01-05");
  const auto late = participants.enrol(person("late", "2026-01-06"), 0, "2026-01-04");
  EXPECT_EQ(late.place, 0u);
  EXPECT_EQ(participants.enrol(person("last", "2026-01-06"), 0, "2026-01-04").place, 2u);
}

TEST_F(Participation, KeepsThePlaceOfWhoeverCompleted) {
  const auto early = enter("early", "2026-01-02");
  answer(early, 0, "a", {});
  participants.complete(early, 1, json::object(), "2026-01-02");
  EXPECT_EQ(participants.enrol(person("late", "2026-01-06"), 0, "2026-01-04").place, 1u);
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

TEST_F(Participation, GivesTheFirstFreePlaceAsTheStudySays) {
  // Against study::next_place, which looks at all places, over random comings and goings.
  std::mt19937 random(3);
  std::vector<study::PlaceState> places;
  std::map<std::size_t, ParticipantRecord> holders;
  for (int i = 0; i < 300; ++i) {
    const auto name = std::to_string(i);
    const auto who = enter(name);
    ASSERT_EQ(who.place, study::next_place(places)) << i;
    places.resize(std::max(places.size(), who.place + 1));
    places[who.place] = study::PlaceState::open;
    holders[who.place] = who;
    const auto chosen = std::next(holders.begin(), random() % holders.size());
    if (random() % 3 != 0) continue;
    if (random() % 2 == 0 && chosen->second.completed_at.empty()) {
      answer(chosen->second, 0, "x", {});
      participants.complete(chosen->second, 1, json::object(), "2026-01-02");
      places[chosen->first] = study::PlaceState::completed;
      chosen->second.completed_at = "2026-01-02";
    } else {
      participants.withdraw(chosen->second.withdrawal_code, "2026-01-02");
      places[chosen->first] = study::PlaceState::dropped;
      holders.erase(chosen);
    }
  }
}

/// One in five drops out, by staying away or by withdrawing; their places go to others. At most 20
/// people are inside. Ten thousand people are tested on study::next_place, which this one equals.
TEST_F(Participation, GivesThePlacesOfPeopleWhoDropOutToOthers) {
  constexpr int people = 500;
  std::mt19937 random(20071);
  std::vector<std::pair<int, ParticipantRecord>> inside;  // since when
  std::set<std::size_t> completed;
  const auto time = [](int second) {
    std::string digits = std::to_string(second);
    return "2026-01-02T" + std::string(6 - digits.size(), '0') + digits;
  };
  std::size_t dropped = 0;
  for (int i = 0; i < people; ++i) {
    auto fresh = person(std::to_string(i), time(i));
    inside.emplace_back(i, participants.enrol(fresh, 0, time(std::max(0, i - 50))));
    if (inside.size() <= 20) continue;
    // Places of those who stayed away for 50 steps are given to others: all leave before.
    const bool due = i - inside.front().first > 40;
    const auto entry =
        inside.begin() + static_cast<std::ptrdiff_t>(due ? 0 : random() % inside.size());
    auto* const chosen = &entry->second;
    if (random() % 5 != 0) {
      participants.complete(*chosen, 0, json::object(), time(i));
      EXPECT_TRUE(completed.insert(chosen->place).second) << "two people completed one place";
    } else {
      ++dropped;
      if (random() % 2 == 0) participants.withdraw(chosen->withdrawal_code, time(i));
    }
    inside.erase(entry);
  }
  EXPECT_GT(dropped, 60u);
  // Below the highest place, all but those of people inside and the last who stayed away are done.
  EXPECT_LE(*completed.rbegin() + 1, completed.size() + 20 + 50);
  EXPECT_EQ(completed.size() + dropped + inside.size(), static_cast<std::size_t>(people));
}

TEST_F(Participation, TakesAsMuchWorkForTheThousandthPersonAsForTheFirst) {
  // Counted in instructions of SQLite, which no other load on the machine changes.
  std::int64_t instructions = 0;
  const auto count_from_here = [&] {
    database.write([&](SQLite::Database& connection) {
      sqlite3_progress_handler(
          connection.getHandle(), 1,
          [](void* sum) { return ++*static_cast<std::int64_t*>(sum), 0; }, &instructions);
    });
    instructions = 0;
  };
  const auto work_for = [&](int from, int to) {
    count_from_here();
    for (int i = from; i < to; ++i) enter(std::to_string(i));
    return instructions;
  };
  work_for(0, 20);
  const auto first = work_for(20, 40);
  work_for(40, 1000);
  const auto last = work_for(1000, 1020);
  EXPECT_GT(first, 20 * 50);
  EXPECT_LT(last, first + first / 10);
  database.write([](SQLite::Database& connection) {
    sqlite3_progress_handler(connection.getHandle(), 0, nullptr, nullptr);
  });
}

TEST_F(Participation, CompilesNoStatementForTheSecondAnswer) {
  // SQLite asks an authorizer about every table that a statement touches when it compiles it.
  std::vector<std::string> compiled;
  database.write([&](SQLite::Database& connection) {
    sqlite3_set_authorizer(
        connection.getHandle(),
        [](void* list, int action, const char* table, const char*, const char*, const char*) {
          const bool bracket = action == SQLITE_TRANSACTION || action == SQLITE_SAVEPOINT;
          if (!bracket)
            static_cast<std::vector<std::string>*>(list)->push_back(std::to_string(action) + " " +
                                                                    (table ? table : ""));
          return SQLITE_OK;
        },
        &compiled);
  });
  const auto who = enter("a");
  answer(who, 0, "x", {{"shelf", 1}});
  EXPECT_THAT(compiled, testing::Contains(testing::EndsWith(" answers")));
  compiled.clear();
  answer(who, 1, "y", {{"shelf", 2}});
  answer(who, 0, "z", {{"shelf", 3}});
  EXPECT_THAT(compiled, testing::IsEmpty());
  database.write([](SQLite::Database& connection) {
    sqlite3_set_authorizer(connection.getHandle(), nullptr, nullptr);
  });
  EXPECT_EQ(count("SELECT COUNT(*) FROM answers"), 3);
}

TEST_F(Participation, LetsPeopleFinishAVersionThatTheNextOneReplaced) {
  const auto who = enter("a");
  studies.put_draft("s", {{"id", "s"}, {"changed", true}}, 43, "2026-01-06");
  studies.start_publishing("s", 2, "other", 0);
  studies.open("s", 2, "2026-01-07");
  EXPECT_EQ(code_of([&] { answer(who, 0, "x", {}); }), "");
  participants.complete(who, 1, json::object(), "2026-01-07");
  EXPECT_EQ(code_of([&] { enter("b"); }), "conflict");  // of version 1, which takes nobody new
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
