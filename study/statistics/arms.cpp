#include "study/statistics/arms.h"

#include <algorithm>
#include <boost/math/distributions/hypergeometric.hpp>
#include <set>

#include "study/statistics/adjust.h"
#include "study/statistics/distributions.h"
#include "study/statistics/json.h"

namespace penumbra::study::statistics {

namespace {

using nlohmann::json;

struct ArmPeople {
  std::string id;
  std::set<std::size_t> people;
  std::size_t inverted = 0;
  std::size_t read_right() const { return people.size() - inverted; }
};

/// Arms by name, with who was assigned to them.
std::vector<ArmPeople> people_by_arm(const SurveyData& data, const std::vector<Flag>& flags) {
  std::set<std::size_t> inverted;
  for (const Flag& flag : flags)
    if (flag.name == "inverted") inverted.insert(flag.participant);
  std::map<std::string, ArmPeople> by_name;
  for (std::size_t i = 0; i < data.participants.size(); ++i) {
    if (data.arms[i].empty()) continue;
    ArmPeople& arm = by_name[data.arms[i]];
    arm.id = data.arms[i];
    arm.people.insert(i);
    arm.inverted += inverted.contains(i) ? 1 : 0;
  }
  std::vector<ArmPeople> list;
  for (auto& [name, arm] : by_name) list.push_back(std::move(arm));
  return list;
}

/// Mean over people of their mean agreement with everybody else.
std::optional<double> mean_rho(const SurveyData& data, const std::vector<Agreement>& agreement,
                               const ArmPeople& arm) {
  std::map<std::size_t, std::pair<double, double>> sums;  // by person: sum, count
  for (std::size_t i = 0; i < data.pages.size(); ++i) {
    const PageAnswer& page = data.pages[i];
    if (page.repeat > 0 || !agreement[i].rho || !arm.people.contains(page.participant)) continue;
    sums[page.participant].first += *agreement[i].rho;
    sums[page.participant].second += 1.0;
  }
  if (sums.empty()) return std::nullopt;
  double sum = 0.0;
  for (const auto& [person, rho] : sums) sum += rho.first / rho.second;
  return sum / static_cast<double>(sums.size());
}

/// Mean over people of their mean rank of each technique.
json means_of(const SurveyData& data, const ArmPeople& arm) {
  Selection selection{std::vector<bool>(data.pages.size()),
                      std::vector<bool>(data.pages.size(), false)};
  for (std::size_t i = 0; i < data.pages.size(); ++i)
    selection.used[i] = arm.people.contains(data.pages[i].participant);
  const auto table = participant_table(data, selection, std::nullopt);
  json list = json::array();
  for (std::size_t column = 0; column < table.techniques.size(); ++column) {
    double sum = 0.0;
    std::size_t n = 0;
    for (const auto& row : table.scaled_ranks) {
      if (is_missing(row[column])) continue;
      sum += row[column] / table.scale;
      ++n;
    }
    list.push_back({{"technique", data.techniques[table.techniques[column]]},
                    {"n", n},
                    {"mean_rank", n > 0 ? json(sum / static_cast<double>(n)) : json(nullptr)}});
  }
  std::stable_sort(list.begin(), list.end(), [](const json& a, const json& b) {
    return a.at("mean_rank") < b.at("mean_rank");
  });
  return list;
}

double share(const ArmPeople& arm) {
  return static_cast<double>(arm.read_right()) / static_cast<double>(arm.people.size());
}

json comparisons_of(const std::vector<ArmPeople>& arms) {
  json list = json::array();
  std::vector<double> p;
  for (std::size_t i = 0; i < arms.size(); ++i)
    for (std::size_t j = i + 1; j < arms.size(); ++j) {
      p.push_back(fisher_exact(arms[i].read_right(), arms[i].inverted, arms[j].read_right(),
                               arms[j].inverted));
      list.push_back({{"a", arms[i].id},
                      {"b", arms[j].id},
                      {"difference", share(arms[i]) - share(arms[j])},
                      {"p_value", p.back()}});
    }
  const auto holm = adjust_holm(p);
  for (std::size_t i = 0; i < p.size(); ++i) list[i]["p_holm"] = holm[i];
  return list;
}

}  // namespace

double fisher_exact(std::size_t a_yes, std::size_t a_no, std::size_t b_yes, std::size_t b_no) {
  const auto yes = static_cast<unsigned>(a_yes + b_yes);
  const auto drawn = static_cast<unsigned>(a_yes + a_no);
  const auto all = drawn + static_cast<unsigned>(b_yes + b_no);
  const boost::math::hypergeometric_distribution<double> chance(yes, drawn, all);
  // Equal probabilities may differ in their last digits (R's fisher.test allows the same).
  const double observed = boost::math::pdf(chance, static_cast<unsigned>(a_yes)) * (1.0 + 1e-7);
  double p = 0.0;
  const unsigned others = all - yes;
  for (unsigned k = drawn > others ? drawn - others : 0; k <= std::min(yes, drawn); ++k) {
    const double one = boost::math::pdf(chance, k);
    if (one <= observed) p += one;
  }
  return std::min(p, 1.0);
}

json arms_json(const SurveyData& data, const std::vector<Flag>& flags) {
  const auto arms = people_by_arm(data, flags);
  if (arms.empty()) return nullptr;
  const auto agreement = leave_one_out(data);
  json list = json::array();
  for (const ArmPeople& arm : arms) {
    const auto n = static_cast<double>(arm.people.size());
    list.push_back({{"arm", arm.id},
                    {"participants", arm.people.size()},
                    {"inverted", arm.inverted},
                    {"read_right", share(arm)},
                    {"ci95", clopper_pearson(static_cast<double>(arm.read_right()), n)},
                    {"mean_rho", value_or_null(mean_rho(data, agreement, arm))},
                    {"techniques", means_of(data, arm)}});
  }
  return {{"list", list}, {"comparisons", comparisons_of(arms)}};
}

}  // namespace penumbra::study::statistics
