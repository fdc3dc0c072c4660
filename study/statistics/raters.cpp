#include "study/statistics/raters.h"

#include <cmath>

#include "study/statistics/agreement.h"
#include "study/statistics/json.h"
#include "study/statistics/screening.h"

namespace penumbra::study::statistics {

namespace {

using nlohmann::json;

/// Moments of the ranks of one picture, a scene and a technique, over first showings.
struct Picture {
  double n = 0.0;
  double sum = 0.0;
  double squares = 0.0;  ///< central, from the second pass on
  double fourths = 0.0;
};

/// Limits beyond which a rank counts; none where fewer than two people judged or all agree.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

Limits limits_of(const Picture& picture) {
  if (picture.n < 2.0 || !(picture.squares > 0.0)) return {};
  const double mean = picture.sum / picture.n;
  const double deviation = std::sqrt(picture.squares / (picture.n - 1.0));
  const double second = picture.squares / picture.n;
  const double kurtosis = picture.fourths / picture.n / (second * second);
  const bool normal = kurtosis >= 2.0 && kurtosis <= 4.0;
  const double reach = (normal ? 2.0 : std::sqrt(20.0)) * deviation;
  return {mean - reach, mean + reach};
}

/// Mean of the values that exist.
std::optional<double> mean_of(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Calls visit(page, technique) for all ranks of first showings.
template <typename Visit>
void each_rank(const SurveyData& data, const Visit& visit) {
  for (const PageAnswer& page : data.pages) {
    if (page.repeat > 0) continue;
    for (std::size_t i = 0; i < page.doubled_ranks.size(); ++i) {
      if (!is_missing(page.doubled_ranks[i])) visit(page, i);
    }
  }
}

/// tau-b of every repeated page with the first showing of its scene.
std::vector<std::vector<double>> repeat_taus(const SurveyData& data) {
  std::vector<std::vector<double>> taus(data.participants.size());
  std::size_t first = 0;  // page where the participant and scene begin; repeats follow in order
  for (std::size_t i = 0; i < data.pages.size(); ++i) {
    const PageAnswer& page = data.pages[i];
    if (page.repeat == 0) {
      first = i;
      continue;
    }
    const PageAnswer& before = data.pages[first];
    if (before.participant != page.participant || before.scene != page.scene || before.repeat > 0)
      continue;
    const auto tau = kendall_tau_b(before.doubled_ranks, page.doubled_ranks);
    if (tau) taus[page.participant].push_back(*tau);
  }
  return taus;
}

}  // namespace

std::vector<Bt500> bt500(const SurveyData& data) {
  std::vector<std::vector<Picture>> pictures(data.scenes.size(),
                                             std::vector<Picture>(data.techniques.size()));
  each_rank(data, [&](const PageAnswer& page, std::size_t i) {
    pictures[page.scene][i].n += 1.0;
    pictures[page.scene][i].sum += page.doubled_ranks[i];
  });
  each_rank(data, [&](const PageAnswer& page, std::size_t i) {
    Picture& picture = pictures[page.scene][i];
    const double d = page.doubled_ranks[i] - picture.sum / picture.n;
    picture.squares += d * d;
    picture.fourths += d * d * d * d;
  });
  std::vector<std::vector<Limits>> limits;
  for (const auto& scene : pictures) {
    limits.emplace_back();
    for (const Picture& picture : scene) limits.back().push_back(limits_of(picture));
  }
  std::vector<Bt500> people(data.participants.size());
  each_rank(data, [&](const PageAnswer& page, std::size_t i) {
    Bt500& person = people[page.participant];
    ++person.judged;
    person.above += page.doubled_ranks[i] >= limits[page.scene][i].high ? 1 : 0;
    person.below += page.doubled_ranks[i] <= limits[page.scene][i].low ? 1 : 0;
  });
  for (Bt500& person : people) {
    const auto above = static_cast<double>(person.above);
    const auto below = static_cast<double>(person.below);
    person.rejected = above + below > 0.05 * static_cast<double>(person.judged) &&
                      std::abs(above - below) < 0.3 * (above + below);
  }
  return people;
}

json raters_json(const SurveyData& data) {
  const auto agreement = leave_one_out(data);
  const auto screened = bt500(data);
  const auto position = positions(data);
  const auto repeats = repeat_taus(data);
  std::vector<std::size_t> pages(data.participants.size(), 0);
  std::vector<std::vector<double>> rhos(data.participants.size());
  std::vector<std::vector<double>> taus(data.participants.size());
  for (std::size_t i = 0; i < data.pages.size(); ++i) {
    const PageAnswer& page = data.pages[i];
    if (page.repeat > 0) continue;
    ++pages[page.participant];
    if (agreement[i].rho) rhos[page.participant].push_back(*agreement[i].rho);
    if (agreement[i].tau_b) taus[page.participant].push_back(*agreement[i].tau_b);
  }
  json list = json::array();
  for (std::size_t i = 0; i < data.participants.size(); ++i) {
    list.push_back({{"participant", data.participants[i]},
                    {"pages", pages[i]},
                    {"mean_rho", value_or_null(mean_of(rhos[i]))},
                    {"mean_tau_b", value_or_null(mean_of(taus[i]))},
                    {"repeat_tau_b", value_or_null(mean_of(repeats[i]))},
                    {"positional_rho", value_or_null(position[i].mean_rho)},
                    {"bt500",
                     {{"above", screened[i].above},
                      {"below", screened[i].below},
                      {"judged", screened[i].judged},
                      {"rejected", screened[i].rejected}}}});
  }
  return list;
}

}  // namespace penumbra::study::statistics
