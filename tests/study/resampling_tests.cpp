#include "study/statistics/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "study/random.h"
#include "study/statistics/distributions.h"
#include "study/statistics/pairs.h"
#include "study/statistics/raters.h"
#include "survey_rows.h"

namespace penumbra::study::statistics {
namespace resampling_tests {

TEST(Permutation, FriedmansExactTableIsReproduced) {
  // Three blocks of three that agree: 6 of 216 arrangements do. Hollander and Wolfe, table A.22.
  const auto agreed = permute_friedman({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, {});
  EXPECT_TRUE(agreed.exact);
  EXPECT_NEAR(agreed.p_value.value(), 1.0 / 36.0, 1e-12);
  // Four blocks of three, chi-square 6.5: P = 0.042.
  const auto four = permute_friedman({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {2, 1, 3}}, {});
  EXPECT_NEAR(four.p_value.value(), 0.042, 0.0005);
}

TEST(Permutation, DrawnArrangementsAgreeWithThoseCountedOut) {
  // Two more blocks make too many to count: all agree, 6 / 6^8 of arrangements are as extreme.
  const Table agreed(9, {1, 2, 3});
  const auto drawn = permute_friedman(agreed, {});
  EXPECT_FALSE(drawn.exact);
  EXPECT_EQ(drawn.permutations, 9999u);
  EXPECT_NEAR(drawn.p_value.value(), 1.0 / 10000.0, 1e-12);
  EXPECT_EQ(permute_friedman(Table(31, {1, 2, 3}), {}).p_value, std::nullopt);
}

/// Means of exponential values: skewed, where plain percentiles cover too little.
TEST(Bootstrap, IntervalsOfSkewedMeansCoverAsOftenAsTheySay) {
  constexpr int studies = 400;
  Resampling plan;
  plan.resamples = 1000;
  int covered = 0;
  Random random(5);
  for (int i = 0; i < studies; ++i) {
    Table table;
    for (int j = 0; j < 40; ++j) table.push_back({-std::log1p(-random.uniform())});
    plan.seed = static_cast<std::uint64_t>(i);
    const auto interval = bca_of_means(table, plan).front().value();
    covered += interval[0] <= 1.0 && 1.0 <= interval[1] ? 1 : 0;
  }
  // 95 % less what BCa is known to lose at n = 40 (about 2 %), within three standard errors.
  EXPECT_GE(covered, 0.90 * studies);
  EXPECT_LE(covered, 0.98 * studies);
}

TEST(Bootstrap, EqualValuesHaveAnIntervalOfNoWidthAndOneValueHasNone) {
  const auto equal = bca_of_means({{2.0, 1.0}, {2.0, missing}, {2.0, missing}}, {});
  EXPECT_EQ(equal[0], (Interval{2.0, 2.0}));
  EXPECT_EQ(equal[1], std::nullopt);
}

TEST(Bootstrap, ConcordanceOfBlocksThatAgreeIsOneForCertain) {
  EXPECT_EQ(bca_of_kendalls_w(Table(6, {1, 2, 3}), {}), (Interval{1.0, 1.0}));
  EXPECT_EQ(bca_of_kendalls_w(Table(6, {2, 2, 2}), {}), std::nullopt);
}

TEST(Effects, TheIntervalOfDzIsThatOfTheNoncentralT) {
  // R, the sleep data: uniroot(function(x) pt(t, 9, x) - p) / sqrt(10)
  const auto test = paired_t({-1.2, -2.4, -1.3, -1.3, 0.0, -1.0, -1.8, -0.8, -4.6, -1.4});
  EXPECT_NEAR(test.dz.value(), -1.28455756259, 1e-9);
  EXPECT_NEAR(test.dz_ci95.value()[0], -2.11801651398, 1e-6);
  EXPECT_NEAR(test.dz_ci95.value()[1], -0.41462775638, 1e-6);
}

TEST(Effects, TheMatchedRankBiserialFollowsItsClosedForm) {
  // W+ = 1 + 2 + 3 + 4 and W- = 5: r = 1/3, s = sqrt(5 * 6 * 11 / 6) / 15.
  const auto test = signed_rank({1, 2, 3, 4, -5});
  const double half = 1.959963984540054 * std::sqrt(55.0) / 15.0;
  EXPECT_NEAR(test.rank_biserial.value(), 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(test.rank_biserial_ci95.value()[0], std::tanh(std::atanh(1.0 / 3.0) - half), 1e-12);
  EXPECT_NEAR(test.rank_biserial_ci95.value()[1], std::tanh(std::atanh(1.0 / 3.0) + half), 1e-12);
}

TEST(Effects, ElevenPeopleAreTheFewestWhoCanRejectAmong36Pairs) {
  EXPECT_EQ(fewest_for_exact(36, 0.05), 11u);  // 36 / 2^9 > 0.05 > 36 / 2^10
  EXPECT_EQ(fewest_for_exact(1, 0.05), 6u);    // 2 / 64 < 0.05 < 2 / 32
}

/// One who turned the scale round among people who agree lies (n - 1) / sqrt(n) deviations off;
/// BT.500 asks for sqrt(20): it misses the person up to 21 people and rejects from 22 on.
TEST(Bt500Screening, SeesOneInvertedPersonOnlyInLargerGroups) {
  for (const std::size_t people : {21u, 22u}) {
    std::vector<ResponseRow> rows;
    for (std::size_t i = 0; i < people; ++i) {
      for (int j = 0; j < 8; ++j) {
        rows.push_back(row_of(person_name(i), "car", std::string(1, static_cast<char>('a' + j)),
                              i == 0 ? 8 - j : 1 + j));
      }
    }
    const auto screened = bt500(gather(rows));
    EXPECT_EQ(screened[0].rejected, people == 22u) << people;
    EXPECT_FALSE(screened[1].rejected);
  }
}

}  // namespace resampling_tests
}  // namespace penumbra::study::statistics
