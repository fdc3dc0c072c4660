// Who gets which place of a study's balanced orders.
#include <map>
#include <random>
#include <set>

#include "study/enrolment.h"
#include "tests/storage/participation.h"

namespace penumbra::server::storage {
namespace {

using nlohmann::json;

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

}  // namespace
}  // namespace penumbra::server::storage
