#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include "study/random.h"
#include "study/statistics/report.h"
#include "study/statistics/table.h"
#include "tests/study/survey_rows.h"

namespace penumbra::study {
namespace {

using nlohmann::json;

constexpr int pictures = 5;

/// Answers with ties: noisy scores cut into few steps. `holes` leaves out pages and pictures.
void add_scene(const std::string& scene, std::size_t people, double noise, bool holes,
               Random& random, std::vector<ResponseRow>& rows) {
  for (std::size_t person = 0; person < people; ++person) {
    if (holes && random.below(5) == 0) continue;
    const int difficulty = 1 + static_cast<int>(random.below(5));
    for (int i = 0; i < pictures; ++i) {
      if (holes && random.below(8) == 0) continue;
      const double place = std::floor(i + noise * random.uniform());
      rows.push_back(row_of(person_name(person), scene, std::string(1, static_cast<char>('a' + i)),
                            1.0 + place, difficulty));
    }
  }
}

/// What R prints for the mid-ranks of `rows`.
std::map<std::string, double> recomputed(const std::vector<ResponseRow>& rows) {
  const auto folder =
      std::filesystem::temp_directory_path() /
      ("penumbra-r-" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "-" +
       std::to_string(std::hash<std::string>()(PENUMBRA_BINARY_DIR)));
  std::filesystem::create_directories(folder);
  const auto data = statistics::gather(rows);
  std::ofstream csv(folder / "answers.csv");
  csv.precision(17);
  csv << "scene,participant,technique,rank,weight\n";
  for (const auto& page : data.pages) {
    for (std::size_t i = 0; i < data.techniques.size(); ++i) {
      if (statistics::is_missing(page.doubled_ranks[i])) continue;
      csv << data.scenes[page.scene] << ',' << data.participants[page.participant] << ','
          << data.techniques[i] << ',' << 0.5 * page.doubled_ranks[i] << ',' << *page.weight
          << '\n';
    }
  }
  csv.close();
  const std::string command = std::string(PENUMBRA_RSCRIPT) + " --vanilla " + PENUMBRA_SOURCE_DIR +
                              "/tests/statistics_in_r/recompute.R " +
                              (folder / "answers.csv").string();
  std::map<std::string, double> values;
  FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 256> name{};
  double value = 0.0;
  while (std::fscanf(pipe, "%255s %lf", name.data(), &value) == 2) values[name.data()] = value;
  EXPECT_EQ(::pclose(pipe), 0);
  std::filesystem::remove_all(folder);
  return values;
}

class RecomputedInR : public ::testing::Test {
 protected:
  void expect(const std::string& name, const json& ours, double relative) {
    ASSERT_TRUE(values.contains(name)) << name;
    const double theirs = values.at(name);
    EXPECT_NEAR(ours.get<double>(), theirs, relative * std::max(std::abs(theirs), 1e-12)) << name;
    ++compared;
  }

  void expect_scene(const json& part) {
    const std::string scene = part["scene"].get<std::string>() + "|";
    if (part["complete_participants"] == part["participants"]) {
      expect(scene + "friedman|chi_square", part["friedman"]["chi_square"], 1e-9);
      expect(scene + "friedman|p_value", part["friedman"]["p_value"], 1e-8);
    }
    expect(scene + "quade|f", part["quade"]["f"], 1e-9);
    expect(scene + "quade|p_value", part["quade"]["p_value"], 1e-8);
    for (const json& row : part["techniques"]) {
      const std::string name = scene + row["technique"].get<std::string>() + "|";
      for (const char* key : {"mean_rank", "sd", "median", "weighted_mean_rank", "weighted_se"})
        expect(name + key, row[key], 1e-9);
      expect(name + "ci95_low", row["ci95"][0], 1e-8);
      expect(name + "ci95_high", row["ci95"][1], 1e-8);
    }
    for (const char* test : {"paired_t", "wilcoxon", "sign", "nemenyi"}) {
      for (const json& pair : part[test]) expect_pair(scene, test, pair);
    }
  }

  /// R names pairs in alphabetical order, the report in the order of means: signs may turn.
  void expect_pair(const std::string& scene, const std::string& test, const json& pair) {
    const std::string a = pair["a"];
    const std::string b = pair["b"];
    const bool turned = b < a;
    const std::string name = scene + test + "|" + (turned ? b + "|" + a : a + "|" + b) + "|";
    // R's ptukey is good to about 1e-7.
    const double closeness = test == "nemenyi" ? 1e-5 : 1e-7;
    expect(name + "p_value", pair["p_value"], closeness);
    if (test == "nemenyi") return;
    for (const char* key : {"p_bonferroni", "p_holm", "p_hochberg"})
      expect(name + key, pair[key], 1e-7);
    if (test == "paired_t") {
      expect(name + "t", turned ? -pair["t"].get<double>() : pair["t"].get<double>(), 1e-9);
      const double low = pair["dz_ci95"][0];
      const double high = pair["dz_ci95"][1];
      expect(name + "dz_low", turned ? -high : low, 1e-5);
      expect(name + "dz_high", turned ? -low : high, 1e-5);
    }
    if (test == "wilcoxon") {
      const double n = pair["n"];
      const double v = pair["statistic_v"];
      expect(name + "statistic_v", turned ? 0.5 * n * (n + 1.0) - v : v, 1e-12);
    }
  }

  std::map<std::string, double> values;
  int compared = 0;
};

TEST_F(RecomputedInR, AnswersWithTiesMissingPagesAndWeightsGiveTheSameFigures) {
  Random random(20071);
  std::vector<ResponseRow> rows;
  add_scene("full", 14, 6.0, false, random, rows);
  add_scene("noisy", 40, 20.0, false, random, rows);
  add_scene("fine", 9, 1000.0, false, random, rows);  // hardly a tie
  add_scene("holes", 61, 8.0, true, random, rows);
  values = recomputed(rows);
  const json report = statistics_report(rows, {});
  for (const json& part : report["included_sets"]["all"]["scenes"]) expect_scene(part);
  EXPECT_GT(compared, 500);
  RecordProperty("figures_compared", compared);
}

}  // namespace
}  // namespace penumbra::study
