#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "study/statistics/posthoc.h"
#include "study/statistics/survey_data.h"

namespace penumbra::study::statistics {

/// Tests of all pairs of one table, in the order of its techniques, as the contract's lists. Every
/// list of unadjusted p-values carries p_bonferroni, p_holm, p_hochberg and p_shaffer beside.
class PairTests {
 public:
  PairTests(const ParticipantTable& table, std::vector<std::string> names);

  /// Paired t of the digits as typed where all pages have them, otherwise of mean mid-ranks.
  const nlohmann::json& paired_t_list() const { return paired_t_entries; }
  nlohmann::json wilcoxon_list() const;
  nlohmann::json sign_list() const;
  nlohmann::json nemenyi_list() const;
  nlohmann::json conover_list() const;

  /// Size of the families, and what it takes for an exact test to reject in one.
  nlohmann::json family(double alpha) const;

  /// Pairs whose paired t differs after Bonferroni; an untestable pair is not shown to differ.
  std::vector<std::vector<bool>> different(double alpha) const;

 private:
  nlohmann::json named(std::size_t i) const;
  void add_adjusted(const std::vector<double>& p, nlohmann::json& list) const;
  void make_paired_t();

  const ParticipantTable& table;
  std::vector<std::string> names;
  std::vector<Pair> pairs;
  nlohmann::json paired_t_entries = nlohmann::json::array();
  std::vector<double> t_bonferroni;
};

}  // namespace penumbra::study::statistics
