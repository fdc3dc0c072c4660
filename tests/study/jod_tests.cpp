#include "study/statistics/jod.h"

#include <gtest/gtest.h>

#include <cmath>

namespace penumbra::study::statistics {
namespace {

/// Wins of pwcmp's example of tone-mapping operators, examples/ex3_tmo_cmp_data.csv: ferwerda96,
/// hateren06, irawan05, mantiuk08, pattanaik00, ronan12, tmo_camera.
const Table corridor{{0, 13, 7, 3, 10, 7, 1}, {1, 0, 2, 1, 3, 3, 0},  {8, 7, 0, 3, 11, 10, 7},
                     {10, 6, 5, 0, 8, 7, 5},  {2, 11, 1, 1, 0, 6, 0}, {7, 10, 4, 3, 10, 0, 1},
                     {15, 8, 9, 9, 10, 11, 0}};
const Table window{{0, 6, 2, 2, 4, 3, 3},  {6, 0, 1, 1, 2, 3, 3},  {7, 10, 0, 7, 7, 6, 5},
                   {12, 6, 1, 0, 7, 6, 6}, {6, 11, 8, 3, 0, 9, 6}, {5, 12, 5, 0, 3, 0, 3},
                   {9, 7, 5, 7, 9, 6, 0}};

/// examples/ex3_tmo_cmp_scaled.csv of the same repository: maximum likelihood, the first operator
/// at 0.
TEST(JodScaling, ThePublishedExampleOfPwcmpIsReproduced) {
  const std::vector<std::pair<Table, std::vector<double>>> scenes{
      {corridor,
       {0, -1.6059723148447, 0.535862731679754, 0.806309431925902, -0.994844257206552,
        -0.306417042164137, 1.45386950116645}},
      {window,
       {0, -0.341778854672895, 1.2243815440554, 1.24664645788926, 0.95808169052028,
        0.459405826577479, 1.12805399497382}}};
  for (const auto& [wins, published] : scenes) {
    const JodScale scale = scale_jod(wins, false);
    ASSERT_EQ(scale.reason, "");
    for (std::size_t i = 0; i < published.size(); ++i) {
      EXPECT_NEAR(scale.scores[i] - scale.scores[0], published[i], 2e-5) << i;
    }
  }
}

/// With the prior, from the same likelihood and prior written in R and maximised by optim.
TEST(JodScaling, ThePriorIsThatOfTheirCode) {
  const std::vector<double> expected{0.01410465426,  -1.51596818832, 0.53503785190, 0.79168981750,
                                     -0.94617891928, -0.28116748608, 1.40248227002};
  const JodScale scale = scale_jod(corridor, true);
  ASSERT_EQ(scale.reason, "");
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(scale.scores[i], expected[i], 2e-4) << i;
  }
}

/// Their first example: 75 of 100 prefer the second to the first, and the third to the second: one
/// JOD each by definition, though the first and third were never compared.
TEST(JodScaling, ThreeQuartersOfJudgementsAreOneJod) {
  for (const bool prior : {false, true}) {
    const JodScale scale = scale_jod({{0, 25, 0}, {75, 0, 25}, {0, 75, 0}}, prior);
    ASSERT_EQ(scale.reason, "");
    EXPECT_NEAR(scale.scores[0], -1.0, 2e-4);
    EXPECT_NEAR(scale.scores[1], 0.0, 2e-4);
    EXPECT_NEAR(scale.scores[2], 1.0, 2e-4);
  }
}

TEST(JodScaling, WhatHasNoScaleIsSaid) {
  EXPECT_NE(scale_jod({{0, 5}, {0, 0}}, false).reason, "");
  EXPECT_NE(scale_jod({{0, 5, 0, 0}, {5, 0, 0, 0}, {0, 0, 0, 3}, {0, 0, 2, 0}}, true).reason, "");
  EXPECT_NE(scale_jod({{0}}, true).reason, "");
}

/// One comparison by each of 100 people: independent, so that the clustered error is the binomial
/// one through the slope of the normal: sqrt(p q / n) / (phi(x) / sigma), halved for either side of
/// 0.
TEST(JodScaling, ErrorsOfIndependentJudgementsAreBinomial) {
  std::vector<Ranking> rankings;
  for (std::size_t i = 0; i < 100; ++i) {
    rankings.push_back(i < 75 ? Ranking{{{0}, {1}}, 1.0, i} : Ranking{{{1}, {0}}, 1.0, i});
  }
  const auto result = jod_json(rankings, {"a", "b"});
  const double x = 0.6744897501960817;
  const double slope = std::exp(-0.5 * x * x) / std::sqrt(2.0 * 3.14159265358979323846) * x;
  EXPECT_NEAR(result["scores"][0]["jod"].get<double>(), 0.5, 2e-3);
  EXPECT_NEAR(result["scores"][0]["robust_se"].get<double>(),
              0.5 * std::sqrt(0.75 * 0.25 / 100.0) / slope, 2e-3);
}

}  // namespace
}  // namespace penumbra::study::statistics
