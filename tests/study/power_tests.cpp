#include "study/statistics/power.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/error.h"

#include "study/statistics/distributions.h"
#include "survey_rows.h"

namespace penumbra::study {
namespace {

const PowerProgress quiet = [](double, const std::string&) {};

/// Two pictures, one page: a person's difference is -1 with probability p and +1 otherwise, so that
/// all is binomial.
Population two_pictures(double log_odds) {
  return {{"a", "b"}, {0.5 * log_odds, -0.5 * log_odds}, 0.0, 0.0, 0.0, 1};
}

TEST(Power, SimulatedPeopleFollowTheirWorths) {
  const auto table = simulate_mean_ranks(two_pictures(std::log(3.0)), 20'000, 1);
  double first = 0.0;
  for (const auto& row : table) first += row[0] == 1.0 ? 1.0 : 0.0;
  EXPECT_NEAR(first / 20'000.0, 0.75, 4.0 * std::sqrt(0.75 * 0.25 / 20'000.0));
}

/// n = (z_0.975 + z_0.8)^2 variance / difference^2 = 7.849 * 0.75 / 0.25 = 23.5 for p = 0.75, and
/// about two more for t instead of z.
TEST(Power, ParticipantsAgreeWithTheNormalFormula) {
  PowerPlan plan;
  const auto result = participants_to_separate(two_pictures(std::log(3.0)), 0, 1, plan, quiet);
  ASSERT_TRUE(result.participants.has_value());
  EXPECT_NEAR(result.difference, -0.5, 0.04);
  EXPECT_NEAR(result.deviation, std::sqrt(0.75), 0.02);
  EXPECT_GE(*result.participants, 20u);
  EXPECT_LE(*result.participants, 30u);
  EXPECT_GE(result.power, 0.8);
}

TEST(Power, TheDifferenceAskedForIsTheOneSimulatedAndSmallerOnesNeedMore) {
  Population population{{"a", "b", "c", "d", "e"}, {1.0, 0.5, 0.0, -0.5, -1.0}, 0.2, 0.02, 0.5, 6};
  PowerPlan plan;
  plan.difference = 0.6;
  const auto wide = participants_needed(population, plan, quiet);
  EXPECT_NEAR(std::abs(wide.difference), 0.6, 0.05);
  plan.difference = 0.3;
  const auto narrow = participants_needed(population, plan, quiet);
  // Half the difference takes about four times the people.
  EXPECT_NEAR(static_cast<double>(*narrow.participants) / static_cast<double>(*wide.participants),
              4.0, 1.2);
  EXPECT_THROW(
      [&] {
        plan.difference = 50.0;
        participants_needed(population, plan, quiet);
      }(),
      Error);
}

TEST(Power, APilotGivesBackTheWorthsTiesAndSpreadThatMadeIt) {
  const Population made{{"a", "b", "c", "d"}, {0.9, 0.3, -0.3, -0.9}, 0.3, 0.0, 0.8, 6};
  std::vector<ResponseRow> rows;
  const Preferences preferences{{}, made.tie_of_two, made.tie_of_three};
  for (std::size_t person = 0; person < 300; ++person) {
    Random random(9, 1, person);
    auto worths = made.log_worths;
    for (double& worth : worths) {
      worth += made.spread * statistics::normal_quantile(0.001 + 0.998 * random.uniform());
    }
    for (std::size_t page = 0; page < made.pages; ++page) {
      const auto shelves = draw_shelves(worths, preferences, random);
      for (std::size_t i = 0; i < shelves.size(); ++i) {
        rows.push_back(row_of(person_name(person), "scene" + std::to_string(page),
                              made.techniques[i], 1 + shelves[i]));
      }
    }
  }
  const Population found = population_of(statistics::gather(rows), 4);
  EXPECT_EQ(found.pages, 6u);
  EXPECT_NEAR(found.spread, 0.8, 0.25);
  EXPECT_NEAR(found.tie_of_two, 0.3, 0.08);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_LT(found.log_worths[i], found.log_worths[i - 1]);
}

TEST(Power, APilotThatSaysNothingIsRefused) {
  EXPECT_THROW(population_of({}, 1), Error);
  std::vector<ResponseRow> apart;
  for (const char* person : {"P1", "P2"}) {
    for (int i = 0; i < 2; ++i) {
      apart.push_back(row_of(person, "s", std::string(person) + (i == 0 ? "a" : "b"), 1 + i));
    }
  }
  EXPECT_THROW(population_of(statistics::gather(apart), 1), Error);
}

}  // namespace
}  // namespace penumbra::study
