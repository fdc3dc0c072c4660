#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/simulate.h"
#include "study/statistics/survey_data.h"

namespace penumbra::study {

/// People whose answers are simulated: Plackett-Luce with ties, and log worths of their own around
/// common ones.
struct Population {
  std::vector<std::string> techniques;
  std::vector<double> log_worths;
  double tie_of_two = 0.0;
  double tie_of_three = 0.0;
  double spread = 0.0;    ///< standard deviation of a person's own log worths, per technique
  std::size_t pages = 1;  ///< that each person ranks
};

/// The population that a pilot suggests: worths and ties by maximum likelihood (regularised where
/// there is no maximum), and the spread that makes simulated people differ in their mean ranks as
/// much as the pilot's. Throws bad_value where the pilot has fewer than two participants or
/// techniques, or its comparisons are not connected.
Population population_of(const statistics::SurveyData& pilot, std::uint64_t seed);

/// Called with 0 to 1 and what is being done.
using PowerProgress = std::function<void(double, const std::string&)>;

struct PowerPlan {
  double difference = 0.5;  ///< of mean ranks, in ranks
  double alpha = 0.05;      ///< of the family of all pairs, by Bonferroni
  double power = 0.8;
  std::uint64_t seed = 2007;
  std::size_t most_participants = 20'000;
};

/// How many participants a study needs.
struct PowerResult {
  std::optional<std::size_t> participants;  ///< fewest found whose power is enough
  double power = 0.0;                       ///< simulated at that many
  double difference = 0.0;                  ///< of mean ranks, as simulated
  double deviation = 0.0;                   ///< of a participant's difference of the two mean ranks
  std::string a;
  std::string b;
  std::vector<std::pair<std::size_t, double>>
      curve;  ///< power by participants, as it was looked up
  std::string reason;
};

/// Moves the two techniques nearest to the middle apart until their mean ranks differ by
/// `plan.difference`, then looks for the number of participants for which the paired t of their
/// mean ranks, Bonferroni over all pairs, rejects with probability `plan.power`.
PowerResult participants_needed(const Population& population, const PowerPlan& plan,
                                const PowerProgress& progress);

/// The same for two techniques as they are.
PowerResult participants_to_separate(const Population& population, std::size_t a, std::size_t b,
                                     const PowerPlan& plan, const PowerProgress& progress);

/// Log worths whose expected mean ranks are `mean_ranks` (1 is best), by simulation.
std::vector<double> worths_of_means(const std::vector<double>& mean_ranks, Population population,
                                    std::uint64_t seed);

/// Mean ranks, per technique, of `people` simulated people, a row each.
statistics::Table simulate_mean_ranks(const Population& population, std::size_t people,
                                      std::uint64_t seed);

}  // namespace penumbra::study
