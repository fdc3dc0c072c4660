#include <algorithm>

#include "golden.h"
#include "study/statistics/adjust.h"
#include "study/statistics/agreement.h"
#include "study/statistics/descriptives.h"
#include "study/statistics/distributions.h"
#include "study/statistics/omnibus.h"
#include "study/statistics/pairs.h"
#include "study/statistics/posthoc.h"
#include "study/statistics/subsets.h"

namespace penumbra::study::statistics {
namespace {

using nlohmann::json;

std::string pair_name(const json& columns, const Pair& pair) {
  return columns[pair.a].get<std::string>() + "|" + columns[pair.b].get<std::string>();
}

/// Everything that a complete table of golden values says about omnibus tests and their post-hocs.
void expect_table(const Table& table, const json& columns, const json& expected) {
  const Friedman result = friedman(table);
  expect_close(result.test.statistic.value(), expected["friedman_chi2"], 1e-6, "chi2");
  EXPECT_EQ(result.test.df, expected["df"].get<int>());
  expect_close(result.test.p_value.value(), expected["p_chi2"], 1e-6, "p");
  expect_close(result.kendalls_w.value(), expected["kendall_W"], 1e-6, "W");
  expect_close(result.iman_davenport.f.value(), expected["iman_davenport_F"], 1e-6, "F");
  EXPECT_EQ(result.iman_davenport.df1, expected["iman_davenport_df"][0].get<int>());
  EXPECT_EQ(result.iman_davenport.df2, expected["iman_davenport_df"][1].get<int>());
  expect_close(result.iman_davenport.p_value.value(), expected["iman_davenport_p"], 1e-6, "F's p");

  const FTest by_range = quade(table);
  expect_close(by_range.f.value(), expected["quade_F"], 1e-6, "Quade");
  expect_close(by_range.p_value.value(), expected["quade_p"], 1e-6, "Quade's p");

  const auto sums = rank_sums(table);
  const auto pairs = all_pairs(columns.size());
  const auto nemenyi_p = nemenyi(table);
  const auto conover_p = conover(table);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    EXPECT_DOUBLE_EQ(sums[i], expected["rank_sums"][i].get<double>());
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string name = pair_name(columns, pairs[i]);
    expect_close(nemenyi_p[i], expected["nemenyi"]["p"][name], 1e-5, "Nemenyi " + name);
    expect_close(conover_p[i], expected["conover_t"]["p_raw"][name], 1e-6, "Conover " + name);
  }
  const auto k = static_cast<int>(columns.size());
  expect_close(nemenyi_critical_difference(table.size(), k, 0.05), expected["nemenyi"]["cd_05"],
               1e-6, "critical difference at 0.05");
  expect_close(nemenyi_critical_difference(table.size(), k, 0.10), expected["nemenyi"]["cd_10"],
               1e-6, "critical difference at 0.10");
}

/// Bonferroni, Holm, Hochberg and Shaffer of the golden raw p-values.
void expect_adjustments(const json& columns, const json& expected) {
  const json& family = expected["siegel_z"];
  const auto pairs = all_pairs(columns.size());
  std::vector<double> raw;
  for (const Pair& pair : pairs) raw.push_back(family["p_raw"][pair_name(columns, pair)]);
  const auto bonferroni = adjust_bonferroni(raw);
  const auto holm = adjust_holm(raw);
  const auto hochberg = adjust_hochberg(raw);
  const auto shaffer = adjust_shaffer(raw, static_cast<int>(columns.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string name = pair_name(columns, pairs[i]);
    expect_close(bonferroni[i], family["p_bonferroni"][name], 1e-6, "Bonferroni " + name);
    expect_close(holm[i], family["p_holm"][name], 1e-6, "Holm " + name);
    expect_close(hochberg[i], family["p_hochberg"][name], 1e-6, "Hochberg " + name);
    expect_close(shaffer[i], family["p_shaffer_static"][name], 1e-6, "Shaffer " + name);
  }
}

Table negated(Table table) {
  for (auto& row : table) {
    for (double& value : row) value = -value;
  }
  return table;
}

TEST(GoldenStatistics, DemsarsTableOfClassifiersIsReproduced) {
  const json file = golden("demsar2006");
  const json& columns = file["data"]["columns"];
  const Table higher_is_better = table_of(file["data"]["rows"]);
  const Table lower = negated(higher_is_better);
  expect_table(lower, columns, file["expected"]["raw_values"]);
  expect_adjustments(columns, file["expected"]["raw_values"]);
  const Friedman by_rank = friedman(table_of(file["data"]["paper_ranks"]));
  const json& paper = file["expected"]["paper_ranks_tie_corrected"];
  expect_close(by_rank.test.statistic.value(), paper["friedman_chi2"], 1e-6, "chi2");
  expect_close(by_rank.iman_davenport.f.value(), paper["iman_davenport_F"], 1e-6, "F");
  expect_close(by_rank.kendalls_w.value(), paper["kendall_W"], 1e-6, "W");
}

TEST(GoldenStatistics, SachsDiureticsAreReproduced) {
  const json file = golden("sachs_diuretics");
  const Table table = table_of(file["data"]["rows"]);
  expect_table(table, file["data"]["columns"], file["expected"]);
  expect_adjustments(file["data"]["columns"], file["expected"]);
}

TEST(GoldenStatistics, AMatrixWithManyTiesIsReproduced) {
  const json file = golden("skposthocs_df_bn");
  const Table table = table_of(file["data"]["rows"]);
  expect_table(table, file["data"]["columns"], file["expected"]);
  expect_adjustments(file["data"]["columns"], file["expected"]);
}

TEST(GoldenStatistics, RankSumDifferencesAreExact) {
  const json expected = golden("eisinga_exact")["expected"];
  expect_close(exact_rank_sum_difference(100, 100, 100), expected["k100_n100_d100"], 1e-6, "");
  for (int d = 1; d <= 20; ++d) {
    expect_close(exact_rank_sum_difference(d, 5, 5), expected["k5_n5_d1to20"][d - 1], 1e-6,
                 "difference " + std::to_string(d));
  }
  for (const int blocks : {10, 30}) {
    for (const auto& [d, p] : expected["k9_n" + std::to_string(blocks)].items()) {
      expect_close(exact_rank_sum_difference(std::stoi(d), 9, blocks), p, 1e-6, d);
    }
  }
  const json sachs = golden("sachs_diuretics")["expected"]["eisinga_exact"];
  for (const auto& [pair, p] : sachs["p_raw"].items()) {
    expect_close(exact_rank_sum_difference(sachs["D"][pair], 6, 6), p, 1e-6, pair);
  }
}

TEST(GoldenStatistics, TheStudentizedRangeHoldsIntoItsFarTail) {
  const json expected = golden("studentized_range")["expected"];
  int checked = 0;
  for (const json& point : expected["sf"]) {
    if (point["df"] != "Inf") continue;
    const json& best =
        point.contains("p_upper_quad") ? point["p_upper_quad"] : point["p_upper_scipy"];
    expect_close(studentized_range_tail(point["q"], point["k"]), best, 1e-7, point.dump());
    ++checked;
  }
  EXPECT_GT(checked, 10);
  for (const json& point : expected["far_tail_df_inf_complement_form"]) {
    expect_close(studentized_range_tail(point["q"], point["k"]), point["p_upper"], 1e-9,
                 point.dump());
  }
  for (int k = 2; k <= 10; ++k) {
    const auto at = static_cast<std::size_t>(k - 2);
    expect_close(studentized_range_quantile(0.05, k) / std::sqrt(2.0),
                 expected["nemenyi_q05_quad"][at], 1e-9, "q05");
    expect_close(studentized_range_quantile(0.01, k) / std::sqrt(2.0),
                 expected["nemenyi_q01_quad"][at], 1e-9, "q01");
  }
}

TEST(GoldenStatistics, ShaffersCountsAndMultipliersAreHis) {
  const json expected = golden("shaffer_sets")["expected"];
  for (int k = 3; k <= 10; ++k) {
    EXPECT_EQ(shaffer_counts(k), expected["S"][std::to_string(k)].get<std::vector<int>>());
  }
  for (int k = 3; k <= 9; ++k) {
    EXPECT_EQ(shaffer_multipliers(k),
              expected["t_static"][std::to_string(k)].get<std::vector<int>>());
  }
}

TEST(GoldenStatistics, BalancedIncompleteBlocksGiveDurbinsTest) {
  const json file = golden("conover_bibd");
  const Table table = table_of(file["data"]["rows"]);
  const auto unit = rank_sum_test(table, BlockWeights::unit);
  expect_close(unit.statistic.value(), file["expected"]["durbin_chi2"], 1e-6, "Durbin");
  expect_close(unit.p_value.value(), file["expected"]["p_chi2"], 1e-6, "p");
  const auto weighted = rank_sum_test(table, BlockWeights::skillings_mack);
  expect_close(weighted.statistic.value(), file["expected"]["skillings_mack"], 1e-6, "");
}

/// Demsar's printed critical differences, to the digits he prints.
TEST(GoldenStatistics, DemsarsCriticalDifferencesArePublished) {
  const json published = golden("demsar2006")["published"];
  EXPECT_NEAR(nemenyi_critical_difference(14, 4, 0.05), published["cd_05"].get<double>(), 0.005);
  EXPECT_NEAR(nemenyi_critical_difference(14, 4, 0.10), published["cd_10"].get<double>(), 0.005);
}

TEST(GoldenStatistics, StutteringWithAMissingValueGivesSkillingsAndMacksTest) {
  const json file = golden("brady_skillings_mack");
  const auto test = rank_sum_test(table_of(file["data"]["rows"]), BlockWeights::skillings_mack);
  expect_close(test.statistic.value(), file["expected"]["skillings_mack_chi2"], 1e-6, "chi2");
  expect_close(test.p_value.value(), file["expected"]["p"], 1e-6, "p");
  EXPECT_EQ(test.df, 2);
}

TEST(GoldenStatistics, SignedRanksFollowRWithZerosAndTies) {
  const json demsar = golden("demsar2006_wilcoxon");
  const auto dropped = signed_rank(demsar["data"]["diff_times_1000"].get<std::vector<double>>());
  const json& drop = demsar["expected"]["wilcox_drop_zeros"];
  EXPECT_DOUBLE_EQ(dropped.v.value(), drop["V"].get<double>());
  EXPECT_FALSE(dropped.exact);
  expect_close(dropped.p_value.value(), drop["p_normal_cc"], 1e-6, "normal");
  expect_close(dropped.p_exact_conditional.value(), drop["p_exact_conditional"], 1e-9, "exact");

  const json& pratt = demsar["expected"]["pratt"];
  expect_close(dropped.p_pratt.value(), pratt["p_asymptotic"], 1e-6, "Pratt");
  expect_close(dropped.p_pratt_exact.value(), pratt["p_exact"], 1e-9, "Pratt, exact");

  const json ties = golden("wilcoxon_ties");
  const auto simple = signed_rank(ties["data"]["simple"].get<std::vector<double>>());
  EXPECT_DOUBLE_EQ(simple.v.value(), 15.0);
  expect_close(simple.p_value.value(), ties["expected"]["simple"]["p_normal_cc"], 1e-6, "simple");
  expect_close(simple.p_exact_conditional.value(), 0.0625, 1e-9, "simple, exact");
  std::vector<double> differences;
  for (std::size_t i = 0; i < ties["data"]["bortz_x"].size(); ++i) {
    differences.push_back(ties["data"]["bortz_x"][i].get<double>() -
                          ties["data"]["bortz_y"][i].get<double>());
  }
  const auto bortz = signed_rank(differences);
  const json& expected = ties["expected"]["bortz"];
  EXPECT_DOUBLE_EQ(bortz.v.value(), expected["V"].get<double>());
  expect_close(bortz.p_value.value(), expected["p_normal_cc"], 1e-6, "Bortz");
  expect_close(bortz.p_exact_conditional.value(), expected["p_exact_conditional"], 1e-9, "Bortz");

  expect_close(bortz.p_pratt_exact.value(), expected["p_pratt_exact"], 1e-9, "Bortz, Pratt");

  const json darwin = golden("darwin_maize");
  const auto maize = signed_rank(darwin["data"]["diff"].get<std::vector<double>>());
  EXPECT_TRUE(maize.exact);
  EXPECT_DOUBLE_EQ(maize.v.value(), darwin["expected"]["V"].get<double>());
  expect_close(maize.p_value.value(), darwin["expected"]["p_exact"], 1e-9, "maize");
}

std::vector<std::vector<bool>> differing(const json& columns, const json& p, double alpha) {
  std::vector<std::vector<bool>> different(columns.size(),
                                           std::vector<bool>(columns.size(), false));
  for (const Pair& pair : all_pairs(columns.size())) {
    const bool differs = p[pair_name(columns, pair)].get<double>() < alpha;
    different[pair.a][pair.b] = different[pair.b][pair.a] = differs;
  }
  return different;
}

std::vector<std::vector<std::string>> named(const std::vector<std::vector<std::size_t>>& sets,
                                            const json& columns) {
  std::vector<std::vector<std::string>> names;
  for (const auto& set : sets) {
    names.emplace_back();
    for (const std::size_t member : set) names.back().push_back(columns[member]);
  }
  return names;
}

TEST(Subsets, RunsOfNeighboursCanContradictTheTestsAndCliquesCannot) {
  // Of a, b, c in order a and b differ, a and c and b and c do not: a and c share no run.
  const std::vector<std::vector<bool>> different{
      {false, true, false}, {true, false, false}, {false, false, false}};
  EXPECT_EQ(neighbouring_runs(different),
            (std::vector<std::pair<std::size_t, std::size_t>>{{0, 0}, {1, 2}}));
  EXPECT_EQ(maximal_cliques(different), (std::vector<std::vector<std::size_t>>{{0, 2}, {1, 2}}));
}

TEST(GoldenStatistics, LettersFollowPiephosExample) {
  const json file = golden("cld_piepho");
  std::vector<std::vector<bool>> different;
  for (const json& row : file["data"]["p"]) {
    different.emplace_back();
    for (const json& p : row) different.back().push_back(p.get<double>() < 0.05);
  }
  EXPECT_EQ(compact_letters(maximal_cliques(different), 4),
            (std::vector<std::string>{"a", "b", "bc", "c"}));
}

class SyntheticSurvey : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const auto& row : file["data"]["position"]) {
      table.emplace_back();
      for (const auto rank : doubled_ranks(row.get<std::vector<double>>())) {
        table.back().push_back(0.5 * static_cast<double>(rank));
      }
    }
  }

  std::vector<double> differences(const std::string& pair) const {
    const auto a = static_cast<std::size_t>(pair.front() - 'A');
    const auto b = static_cast<std::size_t>(pair.back() - 'A');
    std::vector<double> result;
    for (const auto& row : table) result.push_back(row[a] - row[b]);
    return result;
  }

  const json file = golden("survey_complete");
  const json& items = file["data"]["items"];
  const json& expected = file["expected"];
  Table table;
};

TEST_F(SyntheticSurvey, GivesTheOmnibusTestsOfR) {
  expect_table(table, items, expected);
  expect_adjustments(items, expected);
  const auto weights = file["data"]["difficulty"].get<std::vector<double>>();
  const auto weighted = rank_sum_test(table, BlockWeights::unit, weights);
  const json& form = expected["weighted_friedman_quadratic_form"];
  expect_close(weighted.statistic.value(), form["chi2"], 1e-6, "weighted Friedman");
  expect_close(weighted.p_value.value(), form["p"], 1e-6, "weighted Friedman's p");
}

TEST_F(SyntheticSurvey, GivesThePairwiseTestsOfR) {
  for (const json& row : expected["paired_t"]) {
    const auto test = paired_t(differences(row["pair"]));
    expect_close(test.t.value(), row["t"], 1e-6, "t of " + row["pair"].get<std::string>());
    expect_close(test.p_value.value(), row["p_raw"], 1e-6,
                 "p of " + row["pair"].get<std::string>());
    EXPECT_EQ(test.df, row["df"].get<std::size_t>());
  }
  for (const json& row : expected["wilcoxon"]) {
    const auto test = signed_rank(differences(row["pair"]));
    const auto name = row["pair"].get<std::string>();
    EXPECT_EQ(test.n, row["n_nonzero"].get<std::size_t>()) << name;
    EXPECT_DOUBLE_EQ(test.v.value(), row["V"].get<double>()) << name;
    EXPECT_FALSE(test.exact) << name << ": its differences are tied";
    expect_close(test.p_value.value(), row["p_normal_cc"], 1e-6, name);
    expect_close(test.p_exact_conditional.value(), row["p_exact_conditional"], 1e-9, name);
    EXPECT_NEAR(test.rank_biserial.value(), row["rank_biserial"].get<double>(), 1e-9) << name;
  }
  for (const json& row : expected["sign_test"]) {
    const auto test = sign_test(differences(row["pair"]));
    const auto name = row["pair"].get<std::string>();
    EXPECT_EQ(test.wins_a, row["wins_first"].get<std::size_t>()) << name;
    EXPECT_EQ(test.wins_b, row["wins_second"].get<std::size_t>()) << name;
    expect_close(test.p_value.value(), row["p_two_sided"], 1e-9, name);
    expect_close(test.probability_a_better.value(), row["prob_first_beats_second_ties_half"], 1e-9,
                 name);
  }
}

TEST_F(SyntheticSurvey, GivesTheWeightedMeansAndTheirRobustErrors) {
  const auto weights = file["data"]["difficulty"].get<std::vector<double>>();
  for (std::size_t i = 0; i < items.size(); ++i) {
    std::vector<double> ranks;
    for (const auto& row : table) ranks.push_back(row[i]);
    const auto result = describe(ranks, weights);
    expect_close(result.mean.value(), expected["mean_ranks"][i], 1e-9, "mean");
    expect_close(result.weighted_mean.value(), expected["weighted_mean_ranks"][i], 1e-9,
                 "weighted");
    expect_close(result.effective_n.value(), expected["weighted_kish_neff"], 1e-9, "Kish");
  }
  for (const auto& [pair, row] : expected["weighted_pair_differences"].items()) {
    const auto result = describe(differences(pair), weights);
    expect_close(result.weighted_mean.value(), row["weighted_mean_diff"], 1e-9, pair);
    expect_close(result.weighted_se.value(), row["se_HC1"], 1e-9, pair);
  }
}

TEST_F(SyntheticSurvey, GivesTheAgreementOfEachRaterWithTheOthers) {
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::vector<double> others(items.size(), 0.0);
    for (std::size_t j = 0; j < table.size(); ++j) {
      for (std::size_t k = 0; k < others.size(); ++k) others[k] += j == i ? 0.0 : 2 * table[j][k];
    }
    const json& row = expected["rater_loo"][i];
    expect_close(spearman(table[i], others).value(), row["spearman"], 1e-6, row["rater"]);
    expect_close(kendall_tau_b(table[i], others).value(), row["kendall_tau_b"], 1e-6, row["rater"]);
  }
}

TEST_F(SyntheticSurvey, GivesTheSubsetsAndLetters) {
  const auto pairs = all_pairs(items.size());
  const auto raw = conover(table);
  const auto conover_holm = adjust_holm(raw);
  const auto nemenyi_p = nemenyi(table);
  json by_conover;
  json by_nemenyi;
  json by_t;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string name = pair_name(items, pairs[i]);
    expect_close(conover_holm[i], expected["conover_holm"][name], 1e-6, "Conover-Holm " + name);
    by_conover[name] = conover_holm[i];
    by_nemenyi[name] = nemenyi_p[i];
    by_t[name] = std::min(1.0, 36 * paired_t(differences(name)).p_value.value());
  }
  const auto check = [&](const json& p, const std::string& prefix) {
    const auto cliques = maximal_cliques(differing(items, p, 0.05));
    EXPECT_EQ(named(cliques, items),
              (expected[prefix + "_maximal_cliques"].get<std::vector<std::vector<std::string>>>()))
        << prefix;
    return compact_letters(cliques, items.size());
  };
  const auto conover_letters = check(by_conover, "conover_holm");
  const auto nemenyi_letters = check(by_nemenyi, "nemenyi");
  check(by_t, "paired_t_bonferroni");
  check(expected["wilcoxon_exact_holm"], "wilcoxon_exact_holm");
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string item = items[i];
    EXPECT_EQ(conover_letters[i], expected["conover_holm_cld_multcompView"][item]);
    EXPECT_EQ(nemenyi_letters[i], expected["nemenyi_cld_multcompView"][item]);
  }
}

}  // namespace
}  // namespace penumbra::study::statistics
