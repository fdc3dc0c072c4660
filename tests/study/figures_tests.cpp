#include "study/report/figures.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "study/simulate.h"
#include "study/statistics/report.h"
#include "study_file.h"
#include "tests/figures/xml.h"

namespace penumbra::study {
namespace figures_tests {

using nlohmann::json;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

ResponseRow row_of(const std::string& participant, const std::string& scene,
                   const std::string& technique, double rank) {
  ResponseRow row;
  row.participant = participant;
  row.scene = scene;
  row.technique = technique;
  row.rank = rank;
  return row;
}

const Figure& figure(const std::vector<Figure>& figures, const std::string& name) {
  const auto found = std::find_if(figures.begin(), figures.end(),
                                  [&](const Figure& item) { return item.name == name; });
  if (found == figures.end()) throw std::out_of_range(name);
  return *found;
}

TEST(Figures, OfASimulatedStudyAreWellFormedAndNamedOnce) {
  const Study study = parse_study(thesis_document());
  const auto rows =
      simulate_responses(study, simulate_people(12, 1, 1, 5), default_preferences(study), 5);
  const json report = statistics_report(rows, report_options(study));
  FigureOptions options = figure_options(study);
  options.measures = parse_measures(
      "scene,technique,frame_ms_median,rms_y\n"
      "car,shadow-map,1.5,12\ncar,pcss-nearest,3,4\ncar,reference,90,0\nboxes,reference,80,0\n");
  const auto figures = figures_of(report, options);
  std::set<std::string> names;
  for (const Figure& item : figures) {
    const auto xml = figures::parse_xml(item.svg);
    EXPECT_EQ(xml.error, "") << item.name;
    EXPECT_EQ(xml.named("title").at(0).text, item.title);
    EXPECT_EQ(item.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"),
              std::string::npos);
    EXPECT_TRUE(names.insert(item.name).second) << item.name;
  }
  for (const char* name : {"mean-ranks", "mean-ranks-car", "critical-difference-boxes",
                           "histograms-island", "worths", "perceived-by-rms-y", "pareto-car"})
    EXPECT_TRUE(names.contains(name)) << name;
  // All nine pictures by the study's labels, and its words for the ends.
  const auto texts = figures::parse_xml(figure(figures, "mean-ranks").svg).texts();
  for (const auto& [id, label] : options.labels) EXPECT_THAT(texts, Contains(label));
  EXPECT_THAT(texts, Contains(HasSubstr("most realistic")));
  EXPECT_EQ(figures_of(report, options).front().svg, figures.front().svg);
}

TEST(Figures, ScenesThatNoFileMayBeCalledGetNamesOfTheirOwn) {
  std::vector<ResponseRow> rows;
  for (const char* scene : {"a/b", "A b", "../..", "\xE7\x8C\xAB"})
    for (const char* person : {"P1", "P2"}) {
      rows.push_back(row_of(person, scene, "x", 1));
      rows.push_back(row_of(person, scene, "y", 2));
    }
  std::set<std::string> names;
  for (const Figure& item : figures_of(statistics_report(rows, {}), {}))
    if (item.name.starts_with("mean-ranks")) names.insert(item.name);
  EXPECT_EQ(names, (std::set<std::string>{"mean-ranks", "mean-ranks-a-b", "mean-ranks-a-b-2",
                                          "mean-ranks-scene", "mean-ranks-scene-2"}));
}

TEST(Figures, OfDegenerateSurveysSayWhatIsMissing) {
  std::vector<ResponseRow> tied;
  for (const char* person : {"P1", "P2", "P3"})
    for (const char* technique : {"a", "b"}) tied.push_back(row_of(person, "car", technique, 1));
  // a beats b and c beats d, but nothing holds the two apart or together.
  std::vector<ResponseRow> apart;
  for (const char* person : {"P1", "P2"}) {
    apart.push_back(row_of(person, "car", "a", 1));
    apart.push_back(row_of(person, "car", "b", 2));
    apart.push_back(row_of(person, "boxes", "c", 1));
    apart.push_back(row_of(person, "boxes", "d", 2));
  }
  for (const auto& rows : {std::vector<ResponseRow>{}, tied, apart, {row_of("P1", "car", "a", 1)}})
    for (const char* set : {"all", "without_flagged", "inverted_turned"}) {
      FigureOptions options;
      options.set = set;
      for (const Figure& item : figures_of(statistics_report(rows, {}), options)) {
        EXPECT_EQ(figures::parse_xml(item.svg).error, "") << item.name;
        EXPECT_THAT(item.svg, Not(HasSubstr("nan"))) << item.name;
        EXPECT_THAT(item.svg, Not(HasSubstr("inf\""))) << item.name;
      }
    }
  const auto texts =
      figures::parse_xml(figure(figures_of(statistics_report(apart, {}), {}), "worths").svg)
          .texts();
  EXPECT_THAT(texts, Contains(HasSubstr("no worths")));
}

TEST(Figures, HistogramsCountAMidRankHalfToEachNeighbour) {
  const json report = statistics_report(
      {row_of("P1", "car", "a", 1), row_of("P1", "car", "b", 2), row_of("P1", "car", "c", 2),
       row_of("P2", "car", "a", 2), row_of("P2", "car", "b", 1), row_of("P2", "car", "c", 3)},
      {});
  std::map<std::string, std::vector<double>> histograms;
  for (const json& row : report["included_sets"]["all"]["overall"]["techniques"])
    histograms[row["technique"]] = row["histogram"].get<std::vector<double>>();
  // P1: a 1, b and c share 2 and 3. P2: b 1, a 2, c 3.
  EXPECT_THAT(histograms["a"], ElementsAre(1.0, 1.0, 0.0));
  EXPECT_THAT(histograms["b"], ElementsAre(1.0, 0.5, 0.5));
  EXPECT_THAT(histograms["c"], ElementsAre(0.0, 0.5, 1.5));
}

TEST(Figures, TheCriticalDifferenceIsDemsars) {
  // Demsar 2006, section 3.2.2: 14 data sets, 4 classifiers, alpha 0.05: CD 1.25.
  std::vector<ResponseRow> rows;
  for (int person = 0; person < 14; ++person)
    for (int i = 0; i < 4; ++i)
      rows.push_back(row_of("P" + std::to_string(person), "car", std::string(1, char('a' + i)),
                            1 + (i + person) % 4));
  const json facts =
      statistics_report(rows, {})["included_sets"]["all"]["overall"]["critical_difference"];
  EXPECT_NEAR(facts["value"].get<double>(), 1.25, 0.005);
  EXPECT_EQ(facts["participants"], 14);
  EXPECT_THAT(figure(figures_of(statistics_report(rows, {}), {}), "critical-difference").svg,
              HasSubstr("CD = 1.25 (Nemenyi, α = 0.05, n = 14)"));
}

TEST(Figures, ObjectiveMeasuresAreHeldAgainstRanksWithinEachScene) {
  std::vector<ResponseRow> rows;
  for (const char* person : {"P1", "P2"})
    for (const auto& [technique, rank] :
         std::map<std::string, int>{{"a", 1}, {"b", 2}, {"c", 3}, {"d", 4}})
      rows.push_back(row_of(person, "car", technique, rank));
  FigureOptions options;
  options.measures = parse_measures(
      "technique,scene,ssim,rms_y\na,car,0.9,1\nb,car,0.8,3\nc,car,,2\nd,car,0.1,4\n");
  const auto figures = figures_of(statistics_report(rows, {}), options);
  // Errors 1 3 2 4 against ranks 1 2 3 4: rho 1 - 6*2/60 = 0.8, tau (5 - 1)/6 = 0.67.
  EXPECT_THAT(figure(figures, "perceived-by-rms-y").svg,
              HasSubstr("ρ = 0.80, τ = 0.67, 4 pictures"));
  // More similar is better: a positive correlation means agreement here, too.
  EXPECT_THAT(figure(figures, "perceived-by-ssim").svg,
              HasSubstr("ρ = 1.00, τ = 1.00, 3 pictures"));
}

std::string complaint(const std::string& text) {
  try {
    parse_measures(text);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Measures, FaultsAreNamed) {
  EXPECT_THAT(complaint(""), HasSubstr("no header"));
  EXPECT_THAT(complaint("scene,rms_y\n"), HasSubstr("`technique`"));
  EXPECT_THAT(complaint("scene,technique\ncar,a\n"), HasSubstr("no measure"));
  EXPECT_THAT(complaint("scene,technique,rms_y\ncar,a,much\n"), HasSubstr("line 2, column rms_y"));
  EXPECT_THAT(complaint("scene,technique,rms_y\ncar,a,inf\n"), HasSubstr("line 2, column rms_y"));
  EXPECT_THAT(complaint("scene,technique,rms_y\ncar,a\n"), HasSubstr("line 2: 2 cells"));
  EXPECT_THAT(complaint("scene,technique,rms_y\ncar,a,1\ncar,a,2\n"), HasSubstr("measured above"));
}

}  // namespace figures_tests
}  // namespace penumbra::study
