// How much work it is to store and to read people, counted and not timed.
#include <gmock/gmock.h>
#include <sqlite3.h>

#include "tests/storage/participation.h"

namespace penumbra::server::storage {
namespace {

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

using Compiled = std::vector<std::string>;

/// Notes in `compiled` every table that a statement touches when SQLite compiles it: an authorizer
/// is asked about each.
void note_compiled(SQLite::Database& connection, Compiled& compiled) {
  sqlite3_set_authorizer(
      connection.getHandle(),
      [](void* list, int action, const char* table, const char*, const char*, const char*) {
        const bool bracket = action == SQLITE_TRANSACTION || action == SQLITE_SAVEPOINT;
        if (!bracket)
          static_cast<Compiled*>(list)->push_back(std::to_string(action) + " " +
                                                  (table ? table : ""));
        return SQLITE_OK;
      },
      &compiled);
}

void note_nothing(SQLite::Database& connection) {
  sqlite3_set_authorizer(connection.getHandle(), nullptr, nullptr);
}

TEST_F(Participation, CompilesNoStatementForTheSecondAnswer) {
  Compiled compiled;
  database.write([&](SQLite::Database& connection) { note_compiled(connection, compiled); });
  const auto who = enter("a");
  answer(who, 0, "x", {{"shelf", 1}});
  EXPECT_THAT(compiled, testing::Contains(testing::EndsWith(" answers")));
  compiled.clear();
  answer(who, 1, "y", {{"shelf", 2}});
  answer(who, 0, "z", {{"shelf", 3}});
  EXPECT_THAT(compiled, testing::IsEmpty());
  database.write(note_nothing);
  EXPECT_EQ(count("SELECT COUNT(*) FROM answers"), 3);
}

TEST_F(Participation, CompilesNoStatementForAPersonReadAfterOthers) {
  for (const char* name : {"a", "b", "c"}) {
    const auto who = enter(name);
    answer(who, 0, std::string("x") + name, {{"shelf", 1}});
    answer(who, 0, std::string("y") + name, {{"shelf", 2}});
  }
  // One call at a time reads on one and the same connection.
  Compiled compiled;
  database.read([&](SQLite::Database& connection) { note_compiled(connection, compiled); });
  int replaced = 0;
  const auto read_all = [&] {
    participants.each("s", 1, [&](const ParticipantData& person) {
      replaced += static_cast<int>(person.replaced.size());
    });
  };
  read_all();
  EXPECT_THAT(compiled, testing::Contains(testing::EndsWith(" answers")));
  compiled.clear();
  read_all();
  EXPECT_EQ(replaced, 6);
  EXPECT_THAT(compiled, testing::Not(testing::Contains(testing::EndsWith(" answers"))));
  EXPECT_THAT(compiled, testing::Not(testing::Contains(testing::EndsWith(" exclusions"))));
  database.read(note_nothing);
}

}  // namespace
}  // namespace penumbra::server::storage
