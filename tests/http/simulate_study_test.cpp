// The program's simulated people against the real HTTP interface.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

#include "study/csv.h"
#include "study/responses.h"
#include "tests/http/a_study.h"
#include "tests/http/zip_files.h"

namespace penumbra::server::http {
namespace {

class SimulatedPeople : public AStudy {
 protected:
  /// Exit state of `penumbra simulate-study` for a document, or the study that ships.
  int simulate(const std::string& arguments, const json& document = nullptr) {
    const auto file = (folder.path / "study.json").string();
    std::ofstream(file) << (document.is_null() ? study()["document"] : document).dump();
    const auto url = "http://127.0.0.1:" + std::to_string(server->port());
    const auto command = std::string(PENUMBRA_BINARY_DIR) + "/penumbra simulate-study " + file +
                         " --url '" + url + "' " + arguments + " > /dev/null 2>&1";
    return WEXITSTATUS(std::system(command.c_str()));
  }

  std::string token() { return " --token-file " + (options.data / "researcher.token").string(); }
};

TEST_F(SimulatedPeople, TakePartAsTheyAreToldToAndAreFoundOut) {
  ASSERT_EQ(simulate("--participants 30 --inverted 3 --step 1.5 --seed 4" + token()), 0);
  const auto counts = study()["participants"];
  EXPECT_EQ(counts["entered"], 30);
  EXPECT_EQ(counts["completed"], 30);
  const auto results = body_of(researcher->Get(at + "/results.json"), 200, "Results");
  int inverted = 0;
  int reference_last = 0;
  for (const auto& flag : results["flags"]) {
    if (flag["flag"] != "inverted") continue;
    ++inverted;
    EXPECT_EQ(flag["evidence"]["pages"], 6);
    reference_last += flag["evidence"]["reference_last"].get<int>();
    EXPECT_EQ(flag["evidence"]["turned_round"], 0);
  }
  EXPECT_EQ(inverted, 3);
  // The reference is last in the document, so that it is worth most: read backwards, it comes last
  // on a page with probability 1 - exp(-1.5). On 5 or fewer of 18 pages: once in a million runs.
  EXPECT_GE(reference_last, 6);
  // Worths rise with the document's order, so mean ranks fall: over all nine pictures of all pages,
  // which only holds where answers went to the slots of the pictures they are about.
  const auto& overall = results["included_sets"]["inverted_turned"]["overall"]["techniques"];
  const auto document = study()["document"];
  ASSERT_EQ(overall.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    const auto& entry = document["techniques"][8 - i];
    EXPECT_EQ(overall[i]["technique"], entry["technique"]) << i;
  }
}

/// A line of a CSV by the names of its columns, for cells without quotes.
std::map<std::string, std::string> line_of(const study::CsvRecord& header,
                                           const study::CsvRecord& record) {
  std::map<std::string, std::string> cells;
  for (std::size_t i = 0; i < header.cells.size(); ++i) cells[header.cells[i]] = record.cells.at(i);
  return cells;
}

TEST_F(SimulatedPeople, RanksAreHeldAgainstTimeByAnExperiment) {
  ASSERT_EQ(simulate("--participants 10 --step 2 --seed 5" + token()), 0);
  const json asked{{"kind", "tradeoff"}, {"scene", "boxes"},    {"techniques", {"shadow-map"}},
                   {"size", 24},         {"light_samples", 16}, {"run_ms", 2},
                   {"study", id}};
  const auto started = researcher->Post("/api/v1/experiments", asked.dump(), "application/json");
  const std::string made = started->get_header_value("Location");
  const json state = body_of(started, 202, "Experiment");
  ASSERT_EQ(experiment_over(state["id"])["status"], "done");
  const auto results = body_of(researcher->Get(at + "/results.json"), 200, "Results");
  std::map<std::string, double> ranks;
  for (const auto& scene : results["included_sets"]["all"]["scenes"])
    if (scene["scene"] == "boxes")
      for (const auto& row : scene["techniques"])
        ranks[row["technique"]] = row["weighted_mean_rank"];
  ASSERT_EQ(ranks.size(), 9u);
  const std::string table = researcher->Get(made + "/results.csv")->body;
  study::CsvReader reader(table);
  study::CsvRecord header, record;
  ASSERT_TRUE(reader.next(header));
  while (reader.next(record)) {
    auto line = line_of(header, record);
    if (line["perceived"].empty()) continue;
    EXPECT_NEAR(std::stod(line["perceived"]), ranks.at(line["technique"]), 1e-9);
    ranks.erase(line["technique"]);
  }
  EXPECT_TRUE(ranks.empty()) << ranks.begin()->first;
}

TEST_F(SimulatedPeople, AreSpreadOverTheArmsOfATemplateAndExportedWithThem) {
  auto document = json::parse(researcher->Get("/api/v1/templates/digits-or-shelves")->body);
  document["pages"] = {{{"scene", "boxes"}}, {{"scene", "car"}}, {{"scene", "island"}}};
  ASSERT_EQ(simulate("--participants 24 --inverted 2 --step 2 --seed 9" + token(), document), 0);
  const std::string arms = "/api/v1/studies/digits-or-shelves";
  const auto stored = body_of(researcher->Get(arms), 200, "Study");
  for (const auto& arm : stored["arms"]) {
    EXPECT_EQ(arm["entered"], 8) << arm;
    EXPECT_EQ(arm["answered_all"], 8) << arm;
  }
  const auto results = body_of(researcher->Get(arms + "/results.json"), 200, "Results");
  ASSERT_EQ(results["arms"]["list"].size(), 3u);
  int inverted = 0;
  for (const auto& arm : results["arms"]["list"]) inverted += arm["inverted"].get<int>();
  EXPECT_EQ(inverted, 2) << "digits of either direction are read the right way round";
  // Preferences rise with the document's order in every arm alike.
  for (const auto& arm : results["arms"]["list"])
    EXPECT_EQ(arm["techniques"].front()["technique"], "reference") << arm;
  const auto file = folder.path / "export.zip";
  std::ofstream(file, std::ios::binary) << researcher->Get(arms + "/export.zip")->body;
  const auto files = unpacked(file);
  std::map<std::string, std::string> arm_of;
  std::map<std::string, int> people;
  const auto table = study::parse_csv(files.at("participants.csv"));
  for (std::size_t i = 1; i < table.size(); ++i) {
    const auto person = line_of(table[0], table[i]);
    arm_of[person.at("participant")] = person.at("arm");
    ++people[person.at("arm")];
  }
  EXPECT_EQ(people,
            (std::map<std::string, int>{{"nine-is-best", 8}, {"one-is-best", 8}, {"shelves", 8}}));
  // On a page of digits the best is what has the arm's best digit's end.
  const auto rows = study::parse_csv(files.at("responses.csv"));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto row = line_of(rows[0], rows[i]);
    ASSERT_EQ(row.at("arm"), arm_of.at(row.at("participant")));
    EXPECT_EQ(row.at("digit_as_typed").empty(), row.at("arm") == "shelves");
    EXPECT_EQ(row.at("best_digit"), row.at("arm") == "shelves"        ? ""
                                    : row.at("arm") == "nine-is-best" ? "9"
                                                                      : "1");
  }
  EXPECT_NE(files.at("report.html").find("Ways of giving ranks"), std::string::npos);
  std::set<std::string> explained;
  for (const auto& record : study::parse_csv(files.at("codebook.csv")))
    explained.insert(record.cells[0] + " " + record.cells[1]);
  for (const auto* column :
       {"responses.csv arm", "responses.csv best_digit", "participants.csv arm"})
    EXPECT_TRUE(explained.contains(column)) << column;
}

TEST_F(SimulatedPeople, NeedTheTokenAndAServer) {
  EXPECT_EQ(simulate("--participants 1"), 1);
  EXPECT_EQ(study()["status"], "draft");
  EXPECT_EQ(simulate("--participants 3 --inverted 4" + token()), 2);
}

}  // namespace
}  // namespace penumbra::server::http
