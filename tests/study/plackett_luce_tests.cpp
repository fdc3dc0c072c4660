#include "study/statistics/plackett_luce.h"

#include "golden.h"

namespace penumbra::study::statistics {
namespace {

using nlohmann::json;

/// A ranking from dense places, 0 for an item that was not ranked.
Ranking from_positions(const std::vector<int>& positions, std::size_t cluster,
                       double weight = 1.0) {
  Ranking ranking;
  ranking.cluster = cluster;
  ranking.weight = weight;
  for (int place = 1; place <= static_cast<int>(positions.size()); ++place) {
    std::vector<std::size_t> tied;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (positions[i] == place) tied.push_back(i);
    }
    if (!tied.empty()) ranking.places.push_back(tied);
  }
  return ranking;
}

std::vector<Ranking> from_table(const json& positions, const std::vector<double>& weights = {}) {
  std::vector<Ranking> rankings;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    rankings.push_back(from_positions(positions[i], i, weights.empty() ? 1.0 : weights[i]));
  }
  return rankings;
}

void expect_fit(const PlackettLuce& fit, const json& expected) {
  ASSERT_EQ(fit.reason, "");
  for (std::size_t i = 0; i < fit.log_worths.size(); ++i) {
    EXPECT_NEAR(fit.log_worths[i], expected["log_worth_centered"][i].get<double>(), 1e-5);
    EXPECT_NEAR(std::sqrt(fit.covariance[i][i]), expected["se_centered"][i].get<double>(), 1e-5);
    EXPECT_NEAR(fit.quasi_errors[i], expected["quasi_se"][i].get<double>(), 1e-4);
  }
  EXPECT_NEAR(fit.log_likelihood, expected["loglik"].get<double>(), 1e-6);
  EXPECT_EQ(fit.log_ties.size(), expected["log_tie"].size());
  for (const auto& [order, value] : fit.log_ties) {
    const std::string name = "tie" + std::to_string(order);
    EXPECT_NEAR(value, expected["log_tie"][name].get<double>(), 1e-5) << name;
    EXPECT_NEAR(fit.tie_errors.at(order), expected["se_log_tie"][name].get<double>(), 1e-5) << name;
  }
}

TEST(PlackettLuceFit, TiesPartialRankingsAndMissingTieOrdersAreThoseOfThePackage) {
  for (const char* id : {"pl_fruits3", "pl_fruits4", "pl_missing_tie_order"}) {
    SCOPED_TRACE(id);
    const json file = golden(id);
    const auto items = file["data"]["columns"].size();
    expect_fit(fit_plackett_luce(from_table(file["data"]["positions"]), items),
               file["expected"]["npseudo_0"]);
  }
}

TEST(PlackettLuceFit, ImaginaryComparisonsRegulariseAsInThePackage) {
  for (const char* id : {"pl_fruits3", "pl_fruits4"}) {
    SCOPED_TRACE(id);
    const json file = golden(id);
    const auto items = file["data"]["columns"].size();
    expect_fit(fit_plackett_luce(from_table(file["data"]["positions"]), items, 0.5),
               file["expected"]["npseudo_0.5"]);
  }
  const json survey = golden("survey_complete");
  expect_fit(fit_plackett_luce(from_table(survey["data"]["position"]), 9, 0.5),
             survey["expected"]["pl_npseudo_0.5"]);
}

TEST(PlackettLuceFit, ASeasonOfNascarIsThatOfHunter) {
  const json file = golden("pl_nascar_hunter");
  const std::vector<std::string> drivers = file["data"]["drivers"];
  std::vector<Ranking> races;
  for (const json& order : file["data"]["races_best_first_from_one"]) {
    Ranking race;
    for (const json& driver : order) {
      // Four more drivers always came last; they have no finite worth.
      if (driver.get<std::size_t>() <= drivers.size()) {
        race.places.push_back({driver.get<std::size_t>() - 1});
      }
    }
    races.push_back(race);
  }
  const json& expected = file["expected"];
  ASSERT_EQ(drivers.size(), expected["n_items"].get<std::size_t>());
  const auto fit = fit_plackett_luce(races, drivers.size());
  ASSERT_EQ(fit.reason, "");
  for (const auto& [driver, worth] : expected["log_worth_ref_first"].items()) {
    const auto at = static_cast<std::size_t>(std::find(drivers.begin(), drivers.end(), driver) -
                                             drivers.begin());
    EXPECT_NEAR(fit.log_worths.at(at) - fit.log_worths[0], worth.get<double>(), 1e-5) << driver;
  }
  EXPECT_NEAR(fit.log_likelihood, expected["loglik"].get<double>(), 1e-6);
}

TEST(PlackettLuceFit, GroupsThatWereNeverComparedAreNamed) {
  const auto fit = fit_plackett_luce(from_table(json::parse("[[1,2,0,0],[0,0,1,2],[2,1,0,0]]")), 4);
  EXPECT_EQ(fit.reason, "not connected: some techniques were never compared");
  EXPECT_EQ(fit.groups, (std::vector<std::vector<std::size_t>>{{0, 1}, {2, 3}}));
}

TEST(PlackettLuceFit, DavidsonsPuddingsConverge) {
  const json file = golden("pl_pudding_davidson");
  std::vector<Ranking> rankings;
  for (const json& row : file["data"]["rows"]) {
    const auto i = row[0].get<std::size_t>() - 1;
    const auto j = row[1].get<std::size_t>() - 1;
    rankings.push_back({{{i}, {j}}, row[3], 0});
    rankings.push_back({{{j}, {i}}, row[4], 0});
    rankings.push_back({{{i, j}}, row[5], 0});
  }
  expect_fit(fit_plackett_luce(rankings, 6), file["expected"]["converged"]);
}

TEST(PlackettLuceFit, NetflixRankingsWithoutTiesAreReproduced) {
  const json file = golden("pl_netflix");
  std::vector<Ranking> rankings;
  for (const json& row : file["data"]["rows"]) {
    Ranking ranking;
    ranking.weight = row[0];
    for (int i = 1; i <= 4; ++i) ranking.places.push_back({row[i].get<std::size_t>() - 1});
    rankings.push_back(ranking);
  }
  expect_fit(fit_plackett_luce(rankings, 4), file["expected"]["npseudo_0"]);
}

TEST(PlackettLuceFit, PartialRankingsOfChoixAreReproduced) {
  const json file = golden("pl_choix_rankings2");
  std::vector<Ranking> rankings;
  for (const json& row : file["data"]["rankings_best_first_zero_based"]) {
    Ranking ranking;
    for (const json& item : row) ranking.places.push_back({item.get<std::size_t>()});
    rankings.push_back(ranking);
  }
  const auto fit = fit_plackett_luce(rankings, 4);
  ASSERT_EQ(fit.reason, "");
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(fit.log_worths[i], file["expected"]["log_worth_centered"][i].get<double>(), 1e-6);
  }
  EXPECT_NEAR(fit.log_likelihood, file["expected"]["loglik"].get<double>(), 1e-6);
}

TEST(PlackettLuceFit, StiglersCitationsGiveBradleyTerry) {
  const json file = golden("bt_citations");
  std::vector<Ranking> rankings;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      if (i == j) continue;
      rankings.push_back({{{i}, {j}}, file["data"]["matrix"][i][j], 0});
    }
  }
  const auto fit = fit_plackett_luce(rankings, 4);
  ASSERT_EQ(fit.reason, "");
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& c = fit.covariance;
    EXPECT_NEAR(fit.log_worths[i] - fit.log_worths[0], file["expected"]["ability"][i].get<double>(),
                1e-6);
    EXPECT_NEAR(std::sqrt(std::max(0.0, c[i][i] + c[0][0] - 2.0 * c[i][0])),
                file["expected"]["se"][i].get<double>(), 1e-6);
    EXPECT_NEAR(fit.quasi_errors[i], file["expected"]["quasi_se"][i].get<double>(), 1e-5);
  }
}

TEST(PlackettLuceFit, TheSyntheticSurveyAgreesWithWeightsAndRobustErrors) {
  const json file = golden("survey_complete");
  const auto weights = file["data"]["difficulty"].get<std::vector<double>>();
  for (const bool weighted : {false, true}) {
    const auto rankings =
        from_table(file["data"]["position"], weighted ? weights : std::vector<double>{});
    const auto fit = fit_plackett_luce(rankings, 9);
    const json& expected = file["expected"][weighted ? "pl_weighted_npseudo_0" : "pl_npseudo_0"];
    expect_fit(fit, expected);
    for (std::size_t i = 1; i < 9; ++i) {
      const auto& c = fit.robust_covariance;
      EXPECT_NEAR(std::sqrt(c[i][i] + c[0][0] - 2.0 * c[i][0]),
                  expected["robust_se_ref_first"][i].get<double>(), 1e-5);
    }
  }
}

TEST(PlackettLuceFit, WhatHasNoFiniteMaximumIsReportedAndNotFitted) {
  EXPECT_NE(fit_plackett_luce(from_table(json::parse("[[1,2,3],[1,3,2]]")), 3).reason, "");
  EXPECT_NE(fit_plackett_luce(from_table(json::parse("[[1,1],[1,1]]")), 2).reason, "");
  EXPECT_NE(fit_plackett_luce({}, 3).reason, "");
  EXPECT_NE(fit_plackett_luce(from_table(json::parse("[[1]]")), 1).reason, "");
}

}  // namespace
}  // namespace penumbra::study::statistics
