// How many participants would separate the neighbours of van Sambeek's table 4.9:
//   bench_claims_survey_power
//
// His answers are not published. People are simulated whose expected mean ranks are his means,
// scaled to the mid-ranks' mean of 5, with ties of two and three, six pages each, for several
// spreads between people; then the participants for whom the paired t of mean ranks, Bonferroni
// over 36 pairs, sees each neighbouring difference with a power of 0.8.
#include <cstdio>

#include "bench/van_sambeek_2007.h"
#include "study/power.h"

namespace {

using namespace penumbra;

/// His table's means around 5, as mid-ranks of nine pictures are.
std::vector<double> centred_means(const published::RankingTable& table) {
  double sum = 0.0;
  for (const auto& row : table.rows) sum += row.mean;
  std::vector<double> means;
  for (const auto& row : table.rows) {
    means.push_back(row.mean + 5.0 - sum / static_cast<double>(table.rows.size()));
  }
  return means;
}

}  // namespace

int main() {
  const auto& table = published::ranking_tables.back();
  study::Population population;
  for (const auto& row : table.rows) population.techniques.push_back(row.technique);
  population.tie_of_two = 0.2;
  population.tie_of_three = 0.02;
  population.pages = 6;
  const auto means = centred_means(table);
  std::printf("| neighbours | difference |");
  const std::vector<double> spreads{0.0, 0.5, 1.0};
  for (const double spread : spreads) std::printf(" spread %.1f |", spread);
  std::printf("\n|---|---|---|---|---|\n");
  std::vector<study::Population> people;
  for (const double spread : spreads) {
    population.spread = spread;
    people.push_back(population);
    people.back().log_worths = study::worths_of_means(means, population, 1);
  }
  for (std::size_t i = 0; i + 1 < table.rows.size(); ++i) {
    std::printf("| %s, %s | %.2f |", table.rows[i].technique.c_str(),
                table.rows[i + 1].technique.c_str(), means[i + 1] - means[i]);
    for (const auto& each : people) {
      const auto result =
          study::participants_to_separate(each, i, i + 1, {}, [](double, const std::string&) {});
      if (result.participants) {
        std::printf(" %zu |", *result.participants);
      } else {
        std::printf(" %s |", result.reason.c_str());
      }
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}
