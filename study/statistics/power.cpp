#include "study/statistics/power.h"

#include <algorithm>
#include <cmath>

#include "renderer/error.h"
#include "study/random.h"
#include "study/statistics/distributions.h"
#include "study/statistics/worths.h"

namespace penumbra::study {

namespace {

using statistics::Table;

// Streams of the random numbers of one power analysis.
constexpr std::uint32_t stream_person = 300;
constexpr std::uint32_t stream_studies = 301;

constexpr std::size_t people_to_fit = 1500;   ///< simulated for each look while fitting
constexpr std::size_t people_in_pool = 6000;  ///< from whom studies are drawn
constexpr std::size_t studies_per_look = 2000;
constexpr int bisections = 14;
constexpr double most_shift = 12.0;  ///< log worths further apart never tie or turn round

/// Standard normal by the inverse of its distribution: the same on every machine.
double normal(Random& random) {
  return statistics::normal_quantile(std::clamp(random.uniform(), 1e-15, 1.0 - 1e-15));
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double variance_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return squares / (static_cast<double>(values.size()) - 1.0);
}

std::vector<double> column(const Table& table, std::size_t index) {
  std::vector<double> values;
  for (const auto& row : table) {
    if (!statistics::is_missing(row[index])) values.push_back(row[index]);
  }
  return values;
}

std::vector<double> differences(const Table& table, std::size_t a, std::size_t b) {
  std::vector<double> values;
  for (const auto& row : table) values.push_back(row[a] - row[b]);
  return values;
}

/// Mean over techniques of the variance between participants.
double variance_between(const Table& table) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < table.front().size(); ++i) {
    const auto values = column(table, i);
    if (values.size() < 2) continue;
    sum += variance_of(values);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

/// Where a rising function reaches `target`, between `low` and `high`.
double bisect(double low, double high, double target, const std::function<double(double)>& value) {
  for (int i = 0; i < bisections; ++i) {
    const double middle = 0.5 * (low + high);
    (value(middle) < target ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Share of studies of `n` people, drawn from `pool`, whose paired t rejects at `alpha`.
double power_at(const std::vector<double>& pool, std::size_t n, double alpha, std::uint64_t seed) {
  const double count = static_cast<double>(n);
  const double critical = statistics::t_quantile(1.0 - 0.5 * alpha, count - 1.0);
  Random random(seed, stream_studies, n);
  std::size_t rejected = 0;
  for (std::size_t study = 0; study < studies_per_look; ++study) {
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double value = pool[random.below(pool.size())];
      sum += value;
      squares += value * value;
    }
    const double spread = std::max(0.0, squares - sum * sum / count);
    const double error = std::sqrt(spread / (count - 1.0) / count);
    rejected += std::abs(sum / count) > critical * error ? 1 : 0;
  }
  return static_cast<double>(rejected) / static_cast<double>(studies_per_look);
}

/// The two techniques next to each other whose mean rank is nearest to the middle of all.
std::pair<std::size_t, std::size_t> middle_pair(const Population& population) {
  std::vector<std::size_t> order(population.log_worths.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return population.log_worths[a] > population.log_worths[b];
  });
  const std::size_t at = (order.size() - 2) / 2;
  return {order[at], order[at + 1]};
}

}  // namespace

Table simulate_mean_ranks(const Population& population, std::size_t people, std::uint64_t seed) {
  const Preferences preferences{{}, population.tie_of_two, population.tie_of_three};
  Table table;
  for (std::size_t person = 0; person < people; ++person) {
    Random random(seed, stream_person, person);
    auto worths = population.log_worths;
    for (double& worth : worths) worth += population.spread * normal(random);
    std::vector<double> sums(worths.size(), 0.0);
    for (std::size_t page = 0; page < population.pages; ++page) {
      const auto shelves = draw_shelves(worths, preferences, random);
      const auto ranks = statistics::doubled_ranks({shelves.begin(), shelves.end()});
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += 0.5 * static_cast<double>(ranks[i]);
    }
    for (double& sum : sums) sum /= static_cast<double>(population.pages);
    table.push_back(std::move(sums));
  }
  return table;
}

Population population_of(const statistics::SurveyData& pilot, std::uint64_t seed) {
  if (pilot.participants.size() < 2 || pilot.techniques.size() < 2) {
    throw bad_value("PILOT", "a pilot needs two participants and two techniques at least");
  }
  const statistics::Selection all{std::vector<bool>(pilot.pages.size(), true),
                                  std::vector<bool>(pilot.pages.size(), false)};
  const auto rankings = statistics::rankings_of(pilot, all, std::nullopt, pilot.techniques);
  auto fit = statistics::fit_plackett_luce(rankings, pilot.techniques.size());
  if (!fit.reason.empty()) {
    fit = statistics::fit_plackett_luce(rankings, pilot.techniques.size(),
                                        statistics::default_pseudo_rankings);
  }
  if (!fit.reason.empty()) throw bad_value("PILOT", fit.reason);
  Population population;
  population.techniques = pilot.techniques;
  population.log_worths = fit.log_worths;
  if (fit.log_ties.contains(2)) population.tie_of_two = std::exp(fit.log_ties.at(2));
  if (fit.log_ties.contains(3)) population.tie_of_three = std::exp(fit.log_ties.at(3));
  population.pages = std::max<std::size_t>(
      1, (rankings.size() + pilot.participants.size() / 2) / pilot.participants.size());

  // Without a spread of their own people differ by chance alone; the rest is what they bring.
  auto table = statistics::participant_table(pilot, all, std::nullopt);
  for (auto& row : table.scaled_ranks) {
    for (double& rank : row) rank /= table.scale;
  }
  const double observed = variance_between(table.scaled_ranks);
  const auto simulated = [&](double spread) {
    population.spread = spread;
    return variance_between(simulate_mean_ranks(population, people_to_fit, seed));
  };
  population.spread = simulated(0.0) >= observed ? 0.0 : bisect(0.0, 4.0, observed, simulated);
  return population;
}

PowerResult participants_to_separate(const Population& population, std::size_t a, std::size_t b,
                                     const PowerPlan& plan, const PowerProgress& progress) {
  progress(0.5, "simulating people");
  const auto pool = differences(simulate_mean_ranks(population, people_in_pool, plan.seed), a, b);
  PowerResult result;
  result.a = population.techniques.at(a);
  result.b = population.techniques.at(b);
  result.difference = mean_of(pool);
  result.deviation = std::sqrt(variance_of(pool));
  const auto k = static_cast<double>(population.techniques.size());
  const double alpha = plan.alpha / (0.5 * k * (k - 1.0));
  const auto look = [&](std::size_t n) {
    const double power = power_at(pool, n, alpha, plan.seed);
    result.curve.emplace_back(n, power);
    return power;
  };

  // Double until the power is enough, then halve the step.
  std::size_t enough = 4;
  std::size_t too_few = 3;
  while (true) {
    progress(0.6, std::to_string(enough) + " participants");
    if (look(enough) >= plan.power) break;
    too_few = enough;
    if (enough >= plan.most_participants) {
      result.reason = "more than " + std::to_string(plan.most_participants) + " participants";
      return result;
    }
    enough = std::min(2 * enough, plan.most_participants);
  }
  while (enough - too_few > std::max<std::size_t>(1, enough / 100)) {
    const std::size_t middle = (enough + too_few) / 2;
    progress(0.8, std::to_string(middle) + " participants");
    (look(middle) >= plan.power ? enough : too_few) = middle;
  }
  std::sort(result.curve.begin(), result.curve.end());
  result.participants = enough;
  result.power = std::find_if(result.curve.begin(), result.curve.end(), [&](const auto& point) {
                   return point.first == enough;
                 })->second;
  return result;
}

PowerResult participants_needed(const Population& given, const PowerPlan& plan,
                                const PowerProgress& progress) {
  Population population = given;
  const auto [a, b] = middle_pair(population);
  const double middle = 0.5 * (population.log_worths[a] + population.log_worths[b]);
  const auto difference_at = [&, a = a, b = b](double shift) {
    progress(0.3, "moving two techniques apart");
    population.log_worths[a] = middle + 0.5 * shift;
    population.log_worths[b] = middle - 0.5 * shift;
    return -mean_of(differences(simulate_mean_ranks(population, people_to_fit, plan.seed), a, b));
  };
  if (difference_at(most_shift) < plan.difference) {
    throw bad_value("difference",
                    "two neighbours of this pilot's techniques can differ by at most " +
                        std::to_string(difference_at(most_shift)) + " ranks");
  }
  difference_at(bisect(0.0, most_shift, plan.difference, difference_at));
  return participants_to_separate(population, a, b, plan, progress);
}

std::vector<double> worths_of_means(const std::vector<double>& mean_ranks, Population population,
                                    std::uint64_t seed) {
  population.log_worths.assign(mean_ranks.size(), 0.0);
  // A rank of difference is about 4 / k log units near the middle; smaller steps end nearer.
  double step = 4.0 / static_cast<double>(mean_ranks.size());
  for (int i = 0; i < 40; ++i) {
    const Table table = simulate_mean_ranks(population, people_to_fit, seed);
    for (std::size_t j = 0; j < mean_ranks.size(); ++j) {
      population.log_worths[j] += step * (mean_of(column(table, j)) - mean_ranks[j]);
    }
    if (i > 20) step *= 0.9;
  }
  return population.log_worths;
}

}  // namespace penumbra::study
