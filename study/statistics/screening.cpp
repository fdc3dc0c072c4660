#include "study/statistics/screening.h"

#include <cmath>

#include "study/statistics/agreement.h"

namespace penumbra::study::statistics {

namespace {

/// Sums of doubled ranks per scene and technique, to take one participant out of.
struct Consensus {
  Table sums;
  Table counts;
};

Consensus consensus_of(const SurveyData& data) {
  Consensus all{Table(data.scenes.size(), std::vector<double>(data.techniques.size(), 0.0)), {}};
  all.counts = all.sums;
  for (const PageAnswer& page : data.pages) {
    if (page.repeat > 0) continue;
    for (std::size_t i = 0; i < page.doubled_ranks.size(); ++i) {
      if (is_missing(page.doubled_ranks[i])) continue;
      all.sums[page.scene][i] += page.doubled_ranks[i];
      all.counts[page.scene][i] += 1.0;
    }
  }
  return all;
}

/// What is known of one participant.
struct Person {
  std::vector<std::size_t> pages;  ///< first showings
  std::vector<std::size_t> repeats;
  std::optional<double> mean_rho;
  std::size_t judged = 0;    ///< pages with a rho
  std::size_t negative = 0;  ///< of those, below 0
};

std::vector<Person> people_of(const SurveyData& data, const std::vector<Agreement>& agreement) {
  std::vector<Person> people(data.participants.size());
  for (std::size_t i = 0; i < data.pages.size(); ++i) {
    Person& person = people[data.pages[i].participant];
    if (data.pages[i].repeat > 0) {
      person.repeats.push_back(i);
      continue;
    }
    person.pages.push_back(i);
    const auto& rho = agreement[i].rho;
    if (!rho) continue;
    ++person.judged;
    person.negative += *rho < 0.0 ? 1 : 0;
    person.mean_rho = person.mean_rho.value_or(0.0) + *rho;
  }
  for (Person& person : people) {
    if (person.mean_rho) *person.mean_rho /= static_cast<double>(person.judged);
  }
  return people;
}

std::string page_name(const SurveyData& data, std::size_t page) {
  return "page of " + data.scenes[data.pages[page].scene];
}

void flag_direction(const SurveyData& data, const std::vector<Agreement>& agreement,
                    const Person& person, std::size_t index, const Screening& thresholds,
                    std::vector<Flag>& flags) {
  if (!person.mean_rho) return;
  const double mean = *person.mean_rho;
  const auto judged = static_cast<double>(person.judged);
  if (mean <= thresholds.inverted_rho &&
      static_cast<double>(person.negative) >= thresholds.inverted_share * judged) {
    flags.push_back({index,
                     "inverted",
                     mean,
                     thresholds.inverted_rho,
                     "ranks run against those of the others: the scale was read backwards",
                     {}});
    return;
  }
  for (const std::size_t page : person.pages) {
    const auto& rho = agreement[page].rho;
    if (!rho || person.judged < 2 || *rho > thresholds.page_inverted_rho) continue;
    const double others = (mean * judged - *rho) / (judged - 1.0);
    if (others <= 0.0) continue;
    flags.push_back({index, "page_inverted", *rho, thresholds.page_inverted_rho,
                     page_name(data, page) + " runs against the others, the rest does not", page});
  }
  if (mean < thresholds.unreliable_rho) {
    flags.push_back({index,
                     "unreliable",
                     mean,
                     thresholds.unreliable_rho,
                     "ranks hardly agree with those of the others",
                     {}});
  }
}

void flag_repeats(const SurveyData& data, const Person& person, std::size_t index,
                  const Screening& thresholds, std::vector<Flag>& flags) {
  for (const std::size_t repeat : person.repeats) {
    for (const std::size_t page : person.pages) {
      if (data.pages[page].scene != data.pages[repeat].scene) continue;
      const auto tau =
          kendall_tau_b(data.pages[page].doubled_ranks, data.pages[repeat].doubled_ranks);
      if (!tau || *tau >= thresholds.unreliable_tau) continue;
      flags.push_back({index,
                       "unreliable",
                       *tau,
                       thresholds.unreliable_tau,
                       page_name(data, page) + " was answered otherwise the second time",
                       {}});
    }
  }
}

void flag_flat(const SurveyData& data, const Person& person, std::size_t index,
               const Screening& thresholds, std::vector<Flag>& flags) {
  std::size_t flat = 0;
  for (const std::size_t page : person.pages) {
    const auto tied = static_cast<double>(data.pages[page].pictures + 1);  // all share the middle
    bool equal = data.pages[page].pictures > 1;
    for (const double rank : data.pages[page].doubled_ranks) {
      equal = equal && (is_missing(rank) || rank == tied);
    }
    flat += equal ? 1 : 0;
  }
  if (person.pages.empty()) return;
  const double share = static_cast<double>(flat) / static_cast<double>(person.pages.size());
  if (share > thresholds.flat_share) {
    flags.push_back({index,
                     "flat",
                     share,
                     thresholds.flat_share,
                     "all pictures share a rank on most pages",
                     {}});
  }
}

/// Ranks that follow the slots over enough pictures to be no accident: one page of nine agrees by
/// chance too often, six do not.
void flag_position(const Position& position, std::size_t index, const Screening& thresholds,
                   std::vector<Flag>& flags) {
  constexpr double deviations = 3.3;  // two-sided p of 0.001
  if (!position.mean_rho) return;
  const double limit = std::max(thresholds.positional_rho, deviations * position.deviation);
  if (std::abs(*position.mean_rho) < limit) return;
  flags.push_back({index,
                   "positional",
                   *position.mean_rho,
                   limit,
                   "ranks follow the places on the screen",
                   {}});
}

/// Active seconds per picture, where the page recorded them.
std::optional<double> seconds_per_picture(const SurveyData& data, const Person& person) {
  double seconds = 0.0;
  double pictures = 0.0;
  for (const std::size_t page : person.pages) {
    if (!data.pages[page].active_ms) continue;
    seconds += *data.pages[page].active_ms / 1000.0;
    pictures += static_cast<double>(data.pages[page].pictures);
  }
  if (pictures == 0.0) return std::nullopt;
  return seconds / pictures;
}

/// The smallest pace that is not flagged.
double slowest_fast(const std::vector<std::optional<double>>& paces, const Screening& thresholds) {
  std::vector<double> known;
  for (const auto& pace : paces) {
    if (pace) known.push_back(*pace);
  }
  if (known.size() < 3) return thresholds.fast_seconds;  // no median worth the name
  std::sort(known.begin(), known.end());
  const std::size_t half = known.size() / 2;
  const double median = known.size() % 2 == 1 ? known[half] : 0.5 * (known[half - 1] + known[half]);
  return std::max(thresholds.fast_seconds, thresholds.fast_share * median);
}

}  // namespace

std::vector<Agreement> leave_one_out(const SurveyData& data) {
  const Consensus all = consensus_of(data);
  std::vector<Agreement> agreement(data.pages.size());
  for (std::size_t i = 0; i < data.pages.size(); ++i) {
    const PageAnswer& page = data.pages[i];
    if (page.repeat > 0) continue;
    auto sums = all.sums[page.scene];
    auto counts = all.counts[page.scene];
    // Pages of a participant are together; those of the same scene leave together.
    std::size_t first = i;
    while (first > 0 && data.pages[first - 1].participant == page.participant) --first;
    for (std::size_t j = first;
         j < data.pages.size() && data.pages[j].participant == page.participant; ++j) {
      const PageAnswer& own = data.pages[j];
      if (own.scene != page.scene || own.repeat > 0) continue;
      for (std::size_t k = 0; k < sums.size(); ++k) {
        if (is_missing(own.doubled_ranks[k])) continue;
        sums[k] -= own.doubled_ranks[k];
        counts[k] -= 1.0;
      }
    }
    std::vector<double> others(sums.size(), missing);
    for (std::size_t k = 0; k < sums.size(); ++k) {
      if (counts[k] >= 2.0) others[k] = sums[k] / counts[k];
    }
    agreement[i] = {spearman(page.doubled_ranks, others),
                    kendall_tau_b(page.doubled_ranks, others)};
  }
  return agreement;
}

std::vector<Position> positions(const SurveyData& data) {
  std::vector<Position> result(data.participants.size());
  std::vector<double> pages(result.size(), 0.0);
  for (const PageAnswer& page : data.pages) {
    if (page.repeat > 0) continue;
    const auto rho = spearman(page.doubled_ranks, page.slots);
    if (!rho) continue;
    Position& position = result[page.participant];
    position.mean_rho = position.mean_rho.value_or(0.0) + *rho;
    position.deviation += static_cast<double>(page.pictures) - 1.0;
    pages[page.participant] += 1.0;
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (!result[i].mean_rho) continue;
    *result[i].mean_rho /= pages[i];
    result[i].deviation = 1.0 / std::sqrt(result[i].deviation);
  }
  return result;
}

std::vector<Flag> screen(const SurveyData& data, const Screening& thresholds) {
  const auto agreement = leave_one_out(data);
  const auto people = people_of(data, agreement);
  const auto position = positions(data);
  std::vector<std::optional<double>> paces;
  for (const Person& person : people) paces.push_back(seconds_per_picture(data, person));
  const double pace_limit = slowest_fast(paces, thresholds);
  std::vector<Flag> flags;
  for (std::size_t i = 0; i < people.size(); ++i) {
    flag_direction(data, agreement, people[i], i, thresholds, flags);
    flag_repeats(data, people[i], i, thresholds, flags);
    flag_flat(data, people[i], i, thresholds, flags);
    flag_position(position[i], i, thresholds, flags);
    if (paces[i] && *paces[i] < pace_limit) {
      flags.push_back({i, "fast", *paces[i], pace_limit, "active seconds per picture", {}});
    }
  }
  return flags;
}

}  // namespace penumbra::study::statistics
