#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

/// A report's numbers as readers want them: shared by HTML and LaTeX. All functions read documents
/// of statistics_report and take missing fields as missing values.
namespace penumbra::study::report {

std::optional<double> number(const nlohmann::json& object, const char* key);

/// Number of decimals, or a dash where there is no value.
std::string decimal(const std::optional<double>& value, int decimals);

/// "< 0.001", or three decimals; a dash where there is no value.
std::string probability(const std::optional<double>& p);

/// "[2.10, 2.52]", empty where there is none.
std::string interval(const nlohmann::json& object, const char* key, int decimals);

/// Names of pictures by id.
class Names {
 public:
  explicit Names(std::map<std::string, std::string> labels_) : labels(std::move(labels_)) {}
  std::string operator()(const std::string& id) const {
    const auto found = labels.find(id);
    return found == labels.end() ? id : found->second;
  }

 private:
  std::map<std::string, std::string> labels;
};

/// What people know a set of participants by.
struct SetName {
  std::string id;
  std::string title;
  std::string meaning;
};
const std::vector<SetName>& set_names();

/// The omnibus tests, the pairs and the subsets of one part in sentences, with n, statistic,
/// degrees of freedom, p, effect, interval, method and the size of the family.
std::vector<std::string> sentences(const nlohmann::json& part, const Names& names, double alpha);

/// What a reader must know before using the results; the report's own warnings where it has them.
std::vector<std::string> warnings(const nlohmann::json& report);

/// How many pairs of a part differ by the paired t test after Bonferroni, of how many.
struct Differing {
  std::size_t different = 0;
  std::size_t pairs = 0;
};
Differing differing(const nlohmann::json& part, double alpha);

/// Entry of a list of pairs for the techniques of another, whichever is first there.
const nlohmann::json* pair_of(const nlohmann::json& list, const std::string& a,
                              const std::string& b);

}  // namespace penumbra::study::report
