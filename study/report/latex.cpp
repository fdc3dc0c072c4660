#include "study/report/latex.h"

#include <array>
#include <cstdio>

#include "figures/text.h"
#include "study/report/words.h"

namespace penumbra::study {

namespace {

using nlohmann::json;
using report::Names;
using report::number;

char32_t code_point(std::string_view sequence) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(sequence[i]); };
  char32_t code = byte(0);
  if (sequence.size() == 2) code &= 0x1F;
  if (sequence.size() == 3) code &= 0x0F;
  if (sequence.size() == 4) code &= 0x07;
  for (std::size_t i = 1; i < sequence.size(); ++i) code = (code << 6) | (byte(i) & 0x3F);
  return code;
}

/// Letters of Latin-1 that pdflatex sets in its default fonts; the Icelandic ones are not there.
bool is_plain_letter(char32_t code) {
  return code >= 0xC0 && code <= 0xFF && code != 0xD0 && code != 0xF0 && code != 0xDE &&
         code != 0xFE && code != 0xD7 && code != 0xF7;
}

const char* replacement(char first) {
  switch (first) {
    case '\\':
      return "\\textbackslash{}";
    case '~':
      return "\\textasciitilde{}";
    case '^':
      return "\\textasciicircum{}";
    case '<':
      return "\\textless{}";
    case '>':
      return "\\textgreater{}";
    case '|':
      return "\\textbar{}";
    case '"':
      return "''";
    case '[':  // behind the end of a row it would begin an option
      return "{[}";
    case '*':
      return "{*}";
    case '{':
      return "\\{";
    case '}':
      return "\\}";
    case '&':
      return "\\&";
    case '%':
      return "\\%";
    case '$':
      return "\\$";
    case '#':
      return "\\#";
    case '_':
      return "\\_";
    default:
      return nullptr;
  }
}

std::string in_math(const std::string& text) {
  return text == "–" ? "--" : "$" + text + "$";
}

std::string decimal_in_math(const std::optional<double>& value, int decimals) {
  return in_math(value ? figures::fixed_text(*value, decimals) : "–");
}

std::string interval_in_math(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array() || !(*found)[0].is_number()) return "--";
  return "$[" + figures::fixed_text((*found)[0], 2) + ", " + figures::fixed_text((*found)[1], 2) +
         "]$";
}

std::string begin_table(const std::string& caption, const std::string& columns) {
  return "\\begin{table}[htbp]\n\\centering\n\\caption{" + caption + "}\n\\begin{tabular}{" +
         columns + "}\n\\toprule\n";
}

constexpr const char* end_table = "\\bottomrule\n\\end{tabular}\n\\end{table}\n\n";

std::string means_table(const json& part, const std::string& where, const Names& names,
                        const std::string& alpha) {
  std::string text = begin_table(
      "Mean ranks, " + latex_text(where) + ", " + std::to_string(part.value("participants", 0)) +
          " participants. Rank 1 is most realistic; intervals are those of Student's $t$; "
          "techniques that share a letter do not differ (paired $t$, Bonferroni, $\\alpha = " +
          alpha + "$).",
      "lrrrcrl");
  text += "technique & $n$ & mean & s.d. & 95\\% interval & weighted & letters \\\\\n\\midrule\n";
  const json letters = part.value("letters", json::object());
  for (const json& row : part.at("techniques")) {
    const std::string id = row.at("technique");
    text += latex_text(names(id)) + " & " + std::to_string(row.value("n", 0)) + " & " +
            decimal_in_math(number(row, "mean_rank"), 2) + " & " +
            decimal_in_math(number(row, "sd"), 2) + " & " + interval_in_math(row, "ci95") + " & " +
            decimal_in_math(number(row, "weighted_mean_rank"), 2) + " & " +
            latex_text(letters.value(id, "")) + " \\\\\n";
  }
  return text + end_table;
}

std::string pairs_table(const json& part, const std::string& where, const Names& names) {
  const json& tests = part.at("paired_t");
  std::string text = begin_table(
      "All pairs, " + latex_text(where) +
          ": paired $t$ with Bonferroni's $p$, Wilcoxon's signed "
          "ranks $V$ with Holm's $p$, and the probability that the first is put before the second "
          "with its 95\\% interval. Families of " +
          std::to_string(tests.size()) + ".",
      "llrrrrrrrc");
  text +=
      "first & second & $n$ & difference & $t$ & $p$ & $V$ & $p$ & $P$ & interval \\\\\n"
      "\\midrule\n";
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const json& test = tests[i];
    const std::string a = test.at("a");
    const std::string b = test.at("b");
    const json nothing = json::object();
    const json* found = report::pair_of(part.at("wilcoxon"), a, b);
    const json& wilcoxon = found != nullptr ? *found : nothing;
    found = report::pair_of(part.at("sign"), a, b);
    const json& sign = found != nullptr ? *found : nothing;
    text += latex_text(names(a)) + " & " + latex_text(names(b)) + " & " +
            std::to_string(test.value("n", 0)) + " & " +
            decimal_in_math(number(test, "mean_difference"), 2) + " & " +
            decimal_in_math(number(test, "t"), 2) + " & " +
            in_math(report::probability(number(test, "p_bonferroni"))) + " & " +
            decimal_in_math(number(wilcoxon, "statistic_v"), 1) + " & " +
            in_math(report::probability(number(wilcoxon, "p_holm"))) + " & " +
            decimal_in_math(number(sign, "probability_a_better"), 2) + " & " +
            interval_in_math(sign, "ci95") + " \\\\\n";
  }
  return text + end_table;
}

}  // namespace

std::string latex_text(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = figures::utf8_length(text);
    const std::string_view sequence = text.substr(0, std::max<std::size_t>(1, length));
    const char first = text.front();
    if (length == 1) {
      const char* known = replacement(first);
      if (known != nullptr)
        result += known;
      else
        result += first >= 0x20 && first < 0x7F ? first : ' ';
    } else if (length > 1 && is_plain_letter(code_point(sequence))) {
      result += sequence;
    } else {
      std::array<char, 24> number{};
      std::snprintf(number.data(), number.size(), "{[}U+%04X]",
                    static_cast<unsigned>(length == 0 ? 0xFFFD : code_point(sequence)));
      result += number.data();
    }
    text.remove_prefix(sequence.size());
  }
  return result;
}

std::string latex_tables(const json& report, const std::map<std::string, std::string>& labels) {
  const Names names(labels);
  const json& set = report.at("included_sets").at("all");
  const std::string alpha = figures::number_text(report.at("methods").value("alpha", 0.05), 4);
  std::string text =
      "% Needs \\usepackage{booktabs}. With many techniques set the table of pairs in \\small.\n\n";
  text += means_table(set.at("overall"), "all scenes", names, alpha);
  for (const json& part : set.at("scenes"))
    text += means_table(part, part.at("scene"), names, alpha);
  text += pairs_table(set.at("overall"), "all scenes", names);
  return text;
}

}  // namespace penumbra::study
