#include "study/report/words.h"

#include <algorithm>
#include <cmath>

#include "figures/text.h"

namespace penumbra::study::report {

namespace {

using figures::shown_number;
using nlohmann::json;

std::string count_of(const json& part, const char* key) {
  const auto found = part.find(key);
  return found != part.end() && found->is_number() ? std::to_string(found->get<long long>()) : "–";
}

std::string reason_of(const json& test) {
  return test.value("reason", "there is too little to test");
}

std::string p_in_words(const std::optional<double>& p) {
  const std::string text = probability(p);
  return text.starts_with("<") ? "p " + text : "p = " + text;
}

std::string friedman_sentence(const json& part) {
  const json& test = part.at("friedman");
  const auto statistic = number(test, "chi_square");
  if (!statistic) return "Friedman's test cannot be computed: " + reason_of(test) + ".";
  std::string text = "Friedman's test, corrected for ties: χ²(" + count_of(test, "df") +
                     ") = " + decimal(statistic, 2) + ", n = " + count_of(part, "participants") +
                     " participants, " + p_in_words(number(test, "p_value"));
  if (const auto w = number(test, "kendalls_w")) {
    text += "; agreement, Kendall's W = " + decimal(w, 3);
    const std::string reach = interval(test, "kendalls_w_ci95", 3);
    if (!reach.empty()) text += ", 95% interval " + reach;
  }
  if (const auto f = number(test, "iman_davenport_f"))
    text += "; Iman and Davenport's F(" + count_of(test, "df1") + ", " + count_of(test, "df2") +
            ") = " + decimal(f, 2) + ", " + p_in_words(number(test, "f_p_value"));
  return text + ".";
}

std::string other_omnibus(const json& part) {
  std::string text;
  const json& quade = part.at("quade");
  if (const auto f = number(quade, "f"))
    text += "Quade's test: F(" + count_of(quade, "df1") + ", " + count_of(quade, "df2") +
            ") = " + decimal(f, 2) + ", " + p_in_words(number(quade, "p_value")) + ". ";
  const json& mack = part.at("skillings_mack");
  if (const auto statistic = number(mack, "statistic"))
    text += "Skillings and Mack's test, which takes missing pictures: χ²(" + count_of(mack, "df") +
            ") = " + decimal(statistic, 2) + ", " + p_in_words(number(mack, "p_value")) + ".";
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

std::string pairs_sentence(const json& part, const Names& names, double alpha) {
  const Differing count = differing(part, alpha);
  if (count.pairs == 0) return "There are no two techniques to compare.";
  std::string text =
      "Of " + std::to_string(count.pairs) + " pairs, " + std::to_string(count.different) +
      " differ by the paired t test (of " +
      (part.value("paired_t_of", "mid_ranks") == "digits" ? "digits as typed" : "mid-ranks") +
      "; α = " + figures::number_text(alpha, 4) + ", Bonferroni over the family of " +
      std::to_string(count.pairs) + ")";
  std::size_t by_wilcoxon = 0;
  for (const json& row : part.at("wilcoxon"))
    by_wilcoxon += number(row, "p_holm").value_or(1.0) < alpha ? 1 : 0;
  text += ", and " + std::to_string(by_wilcoxon) +
          " by Wilcoxon's signed-rank test (Holm over the same family).";
  const json* clearest = nullptr;
  for (const json& row : part.at("paired_t")) {
    const auto t = number(row, "t");
    if (t && (clearest == nullptr || std::abs(*t) > std::abs(*number(*clearest, "t"))))
      clearest = &row;
  }
  if (clearest == nullptr) return text;
  std::string a = clearest->at("a");
  std::string b = clearest->at("b");
  const auto difference = number(*clearest, "mean_difference");
  text += " The clearest difference: " + names(a) + " and " + names(b) + ", mean difference " +
          decimal(difference, 2) + " ranks, t(" + count_of(*clearest, "df") +
          ") = " + decimal(number(*clearest, "t"), 2) + ", n = " + count_of(*clearest, "n") + ", " +
          p_in_words(number(*clearest, "p_bonferroni")) + " after Bonferroni";
  if (const json* sign = pair_of(part.at("sign"), a, b)) {
    if (const auto better = number(*sign, "probability_a_better"))
      text += "; " + names(sign->at("a")) + " was put before " + names(sign->at("b")) + " in " +
              decimal(100.0 * *better, 0) + "% of cases, 95% interval " +
              interval(*sign, "ci95", 2) + " as a probability";
  }
  return text + ".";
}

std::string subsets_sentence(const json& part, const Names& names) {
  std::string text;
  for (const json& subset : part.value("subsets", json::array())) {
    std::string members;
    for (const json& id : subset) members += (members.empty() ? "" : ", ") + names(id);
    text += (text.empty() ? "" : "; ") + members;
  }
  return text.empty() ? "" : "Groups within which no pair differs: " + text + ".";
}

}  // namespace

std::optional<double> number(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::string decimal(const std::optional<double>& value, int decimals) {
  return value ? shown_number(*value, decimals) : "–";
}

std::string probability(const std::optional<double>& p) {
  if (!p) return "–";
  return *p < 0.001 ? "< 0.001" : figures::fixed_text(*p, 3);
}

std::string interval(const json& object, const char* key, int decimals) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array() || found->size() != 2 ||
      !(*found)[0].is_number() || !(*found)[1].is_number())
    return {};
  return "[" + shown_number((*found)[0], decimals) + ", " + shown_number((*found)[1], decimals) +
         "]";
}

const std::vector<SetName>& set_names() {
  static const std::vector<SetName> list{
      {"all", "Everybody", "all participants whom no researcher took out"},
      {"without_flagged", "Without flagged", "the same without participants that have a flag"},
      {"inverted_turned", "Inverted turned round",
       "everybody, with the answers turned round of those who read the scale backwards"}};
  return list;
}

std::vector<std::string> sentences(const json& part, const Names& names, double alpha) {
  std::vector<std::string> list;
  if (part.value("pages", 0) == 0) return {"There are no answers."};
  for (const std::string& sentence :
       {friedman_sentence(part), other_omnibus(part), pairs_sentence(part, names, alpha),
        subsets_sentence(part, names)})
    if (!sentence.empty()) list.push_back(sentence);
  return list;
}

std::vector<std::string> warnings(const json& report) {
  std::vector<std::string> list;
  const auto add = [&](const std::string& text) {
    if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
  };
  if (report.contains("warnings"))
    for (const json& warning : report.at("warnings"))
      add(warning.value("part", "") + " (" + warning.value("set", "") +
          "): " + warning.value("warning", ""));
  const auto check = [&](const json& part, const std::string& where) {
    constexpr int few = 10;  // up to here no exact Wilcoxon can reject among 36 pairs after Holm
    const int participants = part.value("participants", 0);
    if (part.value("pages", 0) == 0)
      add(where + ": no answers.");
    else if (participants <= few)
      add(where + ": few participants (" + std::to_string(participants) +
          "); intervals are wide, and tests of many pairs can hardly reject.");
    if (part.at("friedman").value("reason", "") == "every block is tied throughout")
      add(where + ": all pictures are tied.");
    if (part.at("plackett_luce").contains("reason") && part.value("pages", 0) > 0)
      add(where + ": no worths, " + part["plackett_luce"]["reason"].get<std::string>() + ".");
  };
  const json& all = report.at("included_sets").at("all");
  if (!report.contains("warnings")) {
    check(all.at("overall"), "All scenes");
    for (const json& part : all.at("scenes")) check(part, part.at("scene"));
  }
  for (const json& note : report.value("notes", json::array())) add(note.get<std::string>() + ".");
  return list;
}

Differing differing(const json& part, double alpha) {
  Differing count;
  for (const json& row : part.at("paired_t")) {
    ++count.pairs;
    count.different += number(row, "p_bonferroni").value_or(1.0) < alpha ? 1 : 0;
  }
  return count;
}

const json* pair_of(const json& list, const std::string& a, const std::string& b) {
  for (const json& row : list)
    if ((row.at("a") == a && row.at("b") == b) || (row.at("a") == b && row.at("b") == a))
      return &row;
  return nullptr;
}

}  // namespace penumbra::study::report
