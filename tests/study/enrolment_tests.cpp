#include "study/enrolment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "study/random.h"
#include "study_file.h"

namespace penumbra::study {
namespace {

using nlohmann::json;

using Counts = std::map<std::pair<std::size_t, std::size_t>, int>;  // (thing, position)

/// Largest minus smallest count over all things and positions, absent ones included.
int spread(const Counts& counts, std::size_t things) {
  int low = std::numeric_limits<int>::max();
  int high = 0;
  for (std::size_t thing = 0; thing < things; ++thing) {
    for (std::size_t position = 0; position < things; ++position) {
      const auto found = counts.find({thing, position});
      const int count = found == counts.end() ? 0 : found->second;
      low = std::min(low, count);
      high = std::max(high, count);
    }
  }
  return high - low;
}

struct Tally {
  Counts pages;
  std::map<std::size_t, Counts> pictures;  // by page

  void add(const EnrolmentPlan& plan) {
    std::size_t position = 0;
    for (const PlannedPage& planned : plan.pages) {
      if (planned.kind != PageKind::ranking) continue;
      ++pages[{planned.page, position++}];
      for (std::size_t slot = 0; slot < planned.slots.size(); ++slot) {
        ++pictures[planned.page][{planned.slots[slot], slot}];
      }
    }
  }
};

/// The thesis study with `count` pictures per page.
Study study_with(std::size_t count) {
  json document = thesis_document();
  document["techniques"] = json::array();
  for (std::size_t i = 0; i < count; ++i) document["techniques"].push_back("t" + std::to_string(i));
  return parse_study(document);
}

TEST(Enrolment, CountsPerPositionDifferByAtMostOnePlusThePlacesStillOpen) {
  const Study study = study_with(9);
  Random random(20071);
  std::vector<PlaceState> places;
  std::vector<std::size_t> open;
  Tally tally;
  for (int person = 0; person < 10000; ++person) {
    const std::size_t place = next_place(places);
    if (place == places.size()) places.push_back(PlaceState::open);
    places[place] = PlaceState::open;
    open.push_back(place);
    // Of the people inside, one chosen at random ends: one in five by dropping out.
    while (open.size() > 20) {
      const std::size_t chosen = random.below(open.size());
      const bool drops = random.uniform() < 0.2;
      places[open[chosen]] = drops ? PlaceState::dropped : PlaceState::completed;
      if (!drops) tally.add(plan_enrolment(study, 7, open[chosen]));
      open.erase(open.begin() + static_cast<long>(chosen));
    }
    if (person % 97 != 0) continue;
    const auto free = static_cast<int>(std::count_if(
        places.begin(), places.end(), [](PlaceState s) { return s != PlaceState::completed; }));
    ASSERT_LE(spread(tally.pages, 6), 1 + free);
    for (const auto& [page, counts] : tally.pictures) ASSERT_LE(spread(counts, 9), 1 + free);
  }
  // Once the open places are completed too, nothing but the last unfinished square is left.
  for (std::size_t place = 0; place < places.size(); ++place) {
    if (places[place] != PlaceState::completed) tally.add(plan_enrolment(study, 7, place));
  }
  EXPECT_GT(places.size(), 7000u);
  EXPECT_LT(places.size(), 9000u) << "places of people who dropped out are used again";
  EXPECT_LE(spread(tally.pages, 6), 1);
  for (const auto& [page, counts] : tally.pictures) EXPECT_LE(spread(counts, 9), 1);
}

class Carryover : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Carryover, OverWholeSquaresEveryPictureFollowsEveryOtherEquallyOften) {
  const std::size_t count = GetParam();
  const Study study = study_with(count);
  const std::size_t whole = count % 2 == 0 ? count : 2 * count;
  std::map<std::pair<std::size_t, std::size_t>, int> follows;
  for (std::size_t place = 0; place < 3 * whole; ++place) {
    const EnrolmentPlan plan = plan_enrolment(study, 99, place);
    for (const PlannedPage& planned : plan.pages) {
      if (planned.page != 2) continue;
      for (std::size_t slot = 1; slot < planned.slots.size(); ++slot) {
        ++follows[{planned.slots[slot - 1], planned.slots[slot]}];
      }
    }
  }
  EXPECT_EQ(follows.size(), count * (count - 1));
  for (const auto& [pair, times] : follows) EXPECT_EQ(times, count % 2 == 0 ? 3 : 6);
}

INSTANTIATE_TEST_SUITE_P(EvenAndOdd, Carryover, ::testing::Values(2, 3, 4, 5, 6, 9, 10));

TEST(Enrolment, EveryPlanShowsEveryPageAndPictureOnce) {
  const Study study = study_with(9);
  for (std::size_t place = 0; place < 100; ++place) {
    const EnrolmentPlan plan = plan_enrolment(study, 3, place);
    std::vector<bool> seen(6, false);
    for (const PlannedPage& planned : plan.pages) {
      EXPECT_FALSE(seen[planned.page]);
      seen[planned.page] = true;
      auto slots = planned.slots;
      std::sort(slots.begin(), slots.end());
      for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(slots[i], i);
    }
    EXPECT_EQ(plan.pages.size(), 6u);
  }
}

TEST(Enrolment, PracticeComesFirstAndRepeatsLast) {
  json document = thesis_document();
  document["practice"] = {{"scene", "boxes"}, {"techniques", {"reference", "none"}}};
  document["repeats"] = {"island"};
  const Study study = parse_study(document);
  const EnrolmentPlan plan = plan_enrolment(study, 3, 0);
  ASSERT_EQ(plan.pages.size(), 8u);
  EXPECT_EQ(plan.pages.front().kind, PageKind::practice);
  EXPECT_EQ(page_of(study, plan.pages.front()).scene, "boxes");
  EXPECT_EQ(plan.pages.back().kind, PageKind::repeat);
  EXPECT_EQ(page_of(study, plan.pages.back()).scene, "island");
}

TEST(Enrolment, ARepeatedPageNeverStandsNextToItsFirstShowing) {
  const std::vector<std::vector<std::string>> lists{
      {"island"}, {"island", "car"}, {"car", "boxes", "disco-box", "island", "warehouse-inside"}};
  for (const auto& repeats : lists) {
    json document = thesis_document();
    document["repeats"] = repeats;
    const Study study = parse_study(document);
    std::size_t beside = 0;
    for (std::size_t place = 0; place < 200; ++place) {
      const EnrolmentPlan plan = plan_enrolment(study, 3, place);
      ASSERT_EQ(plan.pages.size(), 6 + repeats.size());
      std::set<std::pair<std::size_t, PageKind>> shown;
      for (std::size_t i = 0; i < plan.pages.size(); ++i) {
        EXPECT_TRUE(shown.emplace(plan.pages[i].page, plan.pages[i].kind).second);
        beside += i > 0 && plan.pages[i].page == plan.pages[i - 1].page ? 1 : 0;
      }
    }
    EXPECT_EQ(beside, 0u) << repeats.size();
  }
}

TEST(Enrolment, TheSeedAloneDecides) {
  const Study study = study_with(9);
  int same = 0;
  for (std::size_t place = 0; place < 50; ++place) {
    const auto a = plan_enrolment(study, 1, place);
    const auto b = plan_enrolment(study, 1, place);
    const auto c = plan_enrolment(study, 2, place);
    for (std::size_t i = 0; i < a.pages.size(); ++i) {
      EXPECT_EQ(a.pages[i].page, b.pages[i].page);
      EXPECT_EQ(a.pages[i].slots, b.pages[i].slots);
      same += a.pages[i].slots == c.pages[i].slots ? 1 : 0;
    }
  }
  EXPECT_LT(same, 5) << "another seed gives other orders";
}

TEST(Enrolment, ADroppedPlaceIsTakenBeforeANewOne) {
  using enum PlaceState;
  const std::vector<PlaceState> places{completed, dropped, open, dropped};
  EXPECT_EQ(next_place(places), 1u);
  EXPECT_EQ(next_place(std::vector<PlaceState>{completed, open}), 2u);
  EXPECT_EQ(next_place({}), 0u);
}

}  // namespace
}  // namespace penumbra::study
