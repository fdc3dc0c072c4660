// The report, the tables for LaTeX and the scripts: judged by expat, pdflatex, R and pandas.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "study/csv.h"
#include "study/report/html.h"
#include "study/report/latex.h"
#include "study/report/scripts.h"
#include "study/simulate.h"
#include "study/statistics/report.h"
#include "study_file.h"
#include "tests/figures/xml.h"

namespace penumbra::study {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string nasty = "a_b & 100% #1 {x} $y$ \\z ~^ <i>\"q\"</i> [u] * \xE7\x9C\x9F \xC3\xA9";

/// A study of few people, one technique of which has a nasty label.
struct Sample {
  Sample() : study(parse_study(document())) {
    rows = simulate_responses(study, simulate_people(14, 2, 1, 7), default_preferences(study), 7);
    rows[0].included = true;
    report = statistics_report(rows, report_options(study));
  }

  static json document() {
    json study = thesis_document();
    study["techniques"][0]["label"] = nasty;
    study["title"]["en"] = "Shadows <script>alert(1)</script> & more";
    return study;
  }

  Study study;
  std::vector<ResponseRow> rows;
  json report;
};

const Sample& sample() {
  static const Sample one;
  return one;
}

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "penumbra-report-XXXXXX").string();
    path = ::mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name, std::ios::binary) << text;
  }
  std::string read(const std::string& name) const {
    std::ifstream file(path / name, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  }

  fs::path path;
};

bool is_installed(const std::string& command) {
  return std::system((command + " > /dev/null 2>&1").c_str()) == 0;
}

TEST(ReportFile, IsOnePageWithoutScriptsOrLinksWhateverTextsHold) {
  ReportContext context{&sample().study, Attendance{15, 12, 1, {{"P7", "<b>asleep</b>"}}},
                        figure_options(sample().study)};
  const std::string page = html_report(sample().report, context);
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
  EXPECT_THAT(page, Not(HasSubstr("href=")));
  EXPECT_THAT(page, Not(HasSubstr("src=")));
  EXPECT_THAT(page, HasSubstr("Shadows &lt;script&gt;alert(1)&lt;/script&gt; &amp; more"));
  // Without the void elements of its head it is XML as well: nothing is left open.
  std::string body = page.substr(page.find("<body>"));
  body.resize(body.find("</html>"));
  const auto xml = figures::parse_xml(body);
  EXPECT_EQ(xml.error, "");
  EXPECT_GE(xml.named("svg").size(), 10u);
  std::vector<std::string> headings;
  for (const auto& heading : xml.named("h2")) headings.push_back(heading.text);
  for (const char* heading : {"What was asked", "Who took part", "Results", "All pairs",
                              "What flags would change", "Methods and versions"})
    EXPECT_THAT(headings, Contains(heading));
}

TEST(ReportFile, SaysTheNumbersOfTheReportInWords) {
  const std::string page =
      html_report(sample().report, {&sample().study, std::nullopt, figure_options(sample().study)});
  const json& test = sample().report["included_sets"]["all"]["overall"]["friedman"];
  std::ostringstream expected;
  expected.precision(2);
  expected << std::fixed << "χ²(8) = " << test["chi_square"].get<double>()
           << ", n = 14 participants";
  EXPECT_THAT(page, HasSubstr(expected.str()));
  EXPECT_THAT(page, HasSubstr("family of 36"));
  int inverted = 0;
  for (const json& flag : sample().report["flags"]) inverted += flag["flag"] == "inverted";
  EXPECT_GT(inverted, 0);
  EXPECT_THAT(page, HasSubstr(std::to_string(inverted) + " inverted"));
}

TEST(ReportFile, OfDegenerateSurveysSaysWhatIsMissing) {
  ResponseRow row;
  row.participant = "P1";
  row.scene = "car";
  row.technique = "a";
  row.rank = 1.0;
  for (const auto& rows : {std::vector<ResponseRow>{}, std::vector<ResponseRow>{row}}) {
    const json report = statistics_report(rows, {});
    const std::string page = html_report(report, {});
    EXPECT_THAT(page, HasSubstr("Before you read on"));
    EXPECT_THAT(page, Not(HasSubstr("nan")));
    EXPECT_FALSE(latex_tables(report, {}).empty());
  }
}

/// Faults that would stop LaTeX: braces, environments, columns of a row.
std::vector<std::string> latex_faults(const std::string& text) {
  std::vector<std::string> faults;
  int depth = 0;
  std::vector<std::string> open;
  std::size_t columns = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("%")) continue;
    std::size_t cells = 1;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '\\') {
        ++i;
        continue;
      }
      depth += line[i] == '{' ? 1 : line[i] == '}' ? -1 : 0;
      cells += line[i] == '&' ? 1 : 0;
      if (depth < 0) faults.push_back("closed too often: " + line);
      if (line[i] == '#' || line[i] == '_' || line[i] == '%' || line[i] == '^' || line[i] == '~')
        faults.push_back("not escaped: " + line);
    }
    const auto name_of = [&](const char* command) {
      const auto at = line.find(command);
      if (at == std::string::npos) return std::string();
      const auto begin = line.find('{', at) + 1;
      return line.substr(begin, line.find('}', begin) - begin);
    };
    if (const auto name = name_of("\\begin"); !name.empty()) open.push_back(name);
    if (line.starts_with("\\begin{tabular}"))
      columns = line.size() - std::string("\\begin{tabular}{}").size();
    if (const auto name = name_of("\\end"); !name.empty()) {
      if (open.empty() || open.back() != name) faults.push_back("ends what is not open: " + line);
      if (!open.empty()) open.pop_back();
    }
    if (line.ends_with("\\\\") && cells != columns) faults.push_back("cells: " + line);
  }
  if (depth != 0 || !open.empty()) faults.push_back("something stays open");
  return faults;
}

TEST(Latex, TablesAreBalancedAndEscaped) {
  const std::string text = latex_tables(sample().report, report_options(sample().study).labels);
  EXPECT_THAT(latex_faults(text), ::testing::IsEmpty());
  EXPECT_THAT(text, HasSubstr("\\toprule"));
  EXPECT_EQ(latex_text("a_b & 50%"), "a\\_b \\& 50\\%");
  EXPECT_EQ(latex_text("[1] \\x {y} ~ ^ \"q\" <>|"),
            "{[}1] \\textbackslash{}x \\{y\\} \\textasciitilde{} \\textasciicircum{} ''q'' "
            "\\textless{}\\textgreater{}\\textbar{}");
  EXPECT_EQ(latex_text("\xE7\x9C\x9F \xC3\xA9 \xFF\n"), "{[}U+771F] \xC3\xA9 {[}U+FFFD] ");
}

TEST(Latex, TablesCompileWherePdflatexIsInstalled) {
  if (!is_installed("pdflatex --version")) {
    std::cout << "pdflatex is not installed: judged by TablesAreBalancedAndEscaped alone\n";
    return;
  }
  const Folder folder;
  folder.write("results.tex", latex_tables(sample().report, report_options(sample().study).labels));
  folder.write("paper.tex",
               "\\documentclass{article}\n\\usepackage{booktabs}\n\\begin{document}\n"
               "\\input{results}\n\\end{document}\n");
  EXPECT_TRUE(is_installed("cd " + folder.path.string() +
                           " && pdflatex -halt-on-error -interaction=nonstopmode paper.tex"))
      << folder.read("paper.log");
}

/// What a script printed, by "scene,quantity".
std::map<std::string, double> printed(const std::string& text) {
  std::map<std::string, double> values;
  for (const auto& record : parse_csv(text))
    if (record.cells.size() == 3 && record.cells[0] != "scene")
      values[record.cells[0] + "," + record.cells[1]] = std::stod(record.cells[2]);
  return values;
}

void expect_part(const json& part, const std::string& scene,
                 const std::map<std::string, double>& values, bool with_p) {
  const auto expect = [&](const std::string& quantity, const json& expected) {
    ASSERT_TRUE(values.contains(scene + "," + quantity)) << scene << " " << quantity;
    EXPECT_NEAR(values.at(scene + "," + quantity), expected.get<double>(),
                1e-8 * std::max(1.0, std::abs(expected.get<double>())))
        << scene << " " << quantity;
  };
  for (const json& row : part["techniques"]) {
    expect("mean_rank:" + row["technique"].get<std::string>(), row["mean_rank"]);
    expect("n:" + row["technique"].get<std::string>(), row["n"]);
  }
  expect("friedman_chi_square", part["friedman"]["chi_square"]);
  expect("friedman_df", part["friedman"]["df"]);
  if (with_p) expect("friedman_p", part["friedman"]["p_value"]);
  for (const json& row : part["paired_t"]) {
    if (row["t"].is_null()) continue;
    const auto a = std::min(row["a"].get<std::string>(), row["b"].get<std::string>());
    const auto b = std::max(row["a"].get<std::string>(), row["b"].get<std::string>());
    const double sign = a == row["a"] ? 1.0 : -1.0;
    expect("paired_t:" + a + ":" + b, json(sign * row["t"].get<double>()));
    if (with_p) expect("p_bonferroni:" + a + ":" + b, row["p_bonferroni"]);
  }
}

/// Runs a script of the export on its responses.csv and compares it with the report.
void expect_script_agrees(const std::string& runner, const std::string& script) {
  const Folder folder;
  folder.write("responses.csv", write_responses(sample().rows));
  for (const EmbeddedFile& file : report_files())
    if (file.path.ends_with(script)) folder.write(script, std::string(file.text));
  const std::string command = "cd " + folder.path.string() + " && " + runner + " " + script +
                              " responses.csv > out.csv 2> errors.txt";
  ASSERT_EQ(std::system(command.c_str()), 0) << folder.read("errors.txt");
  const auto values = printed(folder.read("out.csv"));
  const json& set = sample().report["included_sets"]["all"];
  const bool with_p = values.contains("ALL,friedman_p");
  expect_part(set["overall"], "ALL", values, with_p);
  for (const json& part : set["scenes"]) expect_part(part, part["scene"], values, with_p);
}

TEST(Scripts, RRecomputesTheHeadlineNumbers) {
  if (!is_installed("Rscript --version")) {
    std::cout << "R is not installed: recompute.R was not run\n";
    return;
  }
  expect_script_agrees("Rscript", "recompute.R");
}

TEST(Scripts, PandasRecomputesTheHeadlineNumbers) {
  for (const std::string python : {"python3", "/usr/bin/python3"}) {
    if (!is_installed(python + " -c 'import pandas'")) continue;
    expect_script_agrees(python, "recompute.py");
    return;
  }
  std::cout << "pandas is not installed: recompute.py was not run\n";
}

}  // namespace
}  // namespace penumbra::study
