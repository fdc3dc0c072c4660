
#include <fstream>
#include <map>
#include <set>
#include <thread>

#include "server/http/documents.h"
#include "study/csv.h"
#include "study/responses.h"
#include "tests/http/a_study.h"
#include "tests/http/zip_files.h"

namespace penumbra::server::http {
namespace {

TEST_F(AStudy, ExportsARowPerRankedPicture) {
  publish();
  for (int i = 0; i < 4; ++i) {
    const auto person = enter();
    answer_all(person, 100 * (i + 1));
    body_of(complete(person), 200, "Completion");
  }
  const auto csv = researcher->Get(at + "/responses.csv");
  ASSERT_TRUE(csv);
  EXPECT_EQ(csv->status, 200);
  std::size_t pictures = 0;
  const auto another = enter();
  for (const auto& page : another["pages"])
    if (page["kind"] == "ranking") pictures += page["images"].size();
  EXPECT_EQ(std::count(csv->body.begin(), csv->body.end(), '\n'),
            static_cast<std::ptrdiff_t>(4 * pictures + 1));
  EXPECT_NE(csv->body.find(study()["hash"].get<std::string>()), std::string::npos);
  const auto results = body_of(researcher->Get(at + "/results.json"), 200, "Results");
  EXPECT_EQ(results["participants"], 4);
  const auto counted = study();
  for (const auto& page : counted["scenes"]) EXPECT_EQ(page["answers"], 4);
}

TEST_F(AStudy, HoldsWhatWasMeasuredAgainstWhatWasSeen) {
  publish();
  answer_all(enter(), 1);
  EXPECT_FALSE(results_of_all().contains("objective"));
  EXPECT_EQ(study()["measures"]["pictures"], 0);

  // The worse a picture was ranked, the larger its error and the shorter its time.
  const auto rows = study::parse_responses(researcher->Get(at + "/responses.csv")->body);
  const auto pages = study()["document"]["pages"];
  std::map<std::pair<std::string, std::string>, double> ranks;
  std::map<std::string, int> shown;
  for (const auto& row : rows) {
    ranks[{row.scene, row.preset}] = row.rank;
    shown[row.scene] += row.technique == "reference" ? 0 : 1;
  }
  renders->error_of = [&](const json& request) {
    return ranks[{request.at("scene"), request.at("technique")}];
  };
  const auto measured = [&] {
    body_of(researcher->Post(at + "/measure", "", "application/json"), 202, "Study");
    json measures;
    for (int i = 0; i < 3000 && (measures.is_null() || measures["at_work"] == true); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      measures = study()["measures"];
    }
    return measures;
  };
  // Pictures of another version of the program are not those that were shown.
  renders->another_program = true;
  EXPECT_EQ(measured()["pictures"], 0);
  renders->another_program = false;
  const auto measures = measured();
  EXPECT_EQ(measures["pictures"], measures["pictures_total"]);

  const auto objective = results_of_all().at("objective");
  EXPECT_EQ(objective.at("measures").size(), 2u);  // the null is no measure
  for (const auto& scene : objective.at("measures").at("rms_y").at("scenes")) {
    EXPECT_EQ(scene.at("n"), shown.at(scene.at("scene")));  // the reference is not among them
    EXPECT_EQ(scene.at("spearman"), 1.0);
  }
  EXPECT_EQ(objective["measures"]["frame_ms_median"]["pooled_within_scenes"]["spearman"], -1.0);
  EXPECT_FALSE(objective.at("pareto").empty());
  std::set<std::string> figures;
  const auto list = body_of(researcher->Get(at + "/figures"), 200, "FigureList")["figures"];
  for (const auto& figure : list) figures.insert(figure["name"]);
  EXPECT_TRUE(figures.contains("pareto")) << json(figures).dump();

  // Nothing is measured twice.
  const int submitted = renders->submitted;
  measured();
  EXPECT_EQ(renders->submitted, submitted);
}

TEST_F(AStudy, ExportsEverythingInOneArchive) {
  publish();
  const auto person = enter();
  answer_all(person, 1);
  body_of(put(page_of(person, 0), answer(person["pages"][0], 500, 5)), 200, "AnswerReply");
  body_of(complete(person), 200, "Completion");
  answer_all(enter(), 100);
  const auto archive = researcher->Get(at + "/export.zip");
  ASSERT_TRUE(archive);
  ASSERT_EQ(archive->status, 200);
  const auto file = folder.path / "export.zip";
  std::ofstream(file, std::ios::binary) << archive->body;
  const auto files = unpacked(file);
  // Every file is in the codebook, and every file of the codebook is there.
  std::set<std::string> explained;
  for (const auto& record : study::parse_csv(files.at("codebook.csv")))
    explained.insert(record.cells[0]);
  explained.erase("file");
  std::set<std::string> names;
  for (const auto& [name, bytes] : files) {
    names.insert(name.starts_with("figures/") ? "figures/*.svg" : name);
    EXPECT_FALSE(bytes.empty()) << name;
  }
  EXPECT_EQ(names, explained);
  EXPECT_EQ(files.at("responses.csv"), researcher->Get(at + "/responses.csv")->body);
  const auto rows = study::parse_responses(files.at("responses.csv"));
  ASSERT_EQ(rows.size(), 2u * 6u * 9u);
  EXPECT_FALSE(rows.front().started_at.empty());
  // A pair each of nine pictures on six pages of two people.
  EXPECT_EQ(study::parse_csv(files.at("pairs.csv")).size(), 1u + 2u * 6u * 36u);
  EXPECT_EQ(study::parse_csv(files.at("responses_wide.csv")).size(), 3u);
  EXPECT_EQ(study::parse_csv(files.at("participants.csv")).size(), 3u);
  const auto people = json::parse(files.at("responses.json"))["participants"];
  ASSERT_EQ(people.size(), 2u);
  EXPECT_FALSE(people[0]["completed_at"].is_null());
  EXPECT_TRUE(people[1]["completed_at"].is_null());
  const auto& first = people[0]["pages"][0];
  EXPECT_EQ(first["answer"]["body"]["difficulty"], 5);
  ASSERT_EQ(first["earlier_answers"].size(), 1u);
  EXPECT_EQ(first["earlier_answers"][0]["body"]["difficulty"], 3);
  EXPECT_EQ(first["pictures_by_slot"].size(), 9u);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path / "data" / "tmp"));
}

TEST_F(AStudy, ShowsItsReportAndFigures) {
  publish();
  EXPECT_EQ(error_of(client->Get(at + "/report.html"), 401), "unauthorized");
  for (int i = 1; i < 4; ++i) answer_all(enter(), 100 * i);
  const auto report = researcher->Get(at + "/report.html");
  ASSERT_TRUE(report);
  EXPECT_EQ(report->status, 200);
  EXPECT_EQ(report->get_header_value("Content-Type"), "text/html; charset=utf-8");
  EXPECT_NE(report->get_header_value("Content-Security-Policy").find("default-src 'none'; style"),
            std::string::npos);
  EXPECT_NE(report->body.find("Which shadows look real?"), std::string::npos);
  const auto list = body_of(researcher->Get(at + "/figures"), 200, "FigureList")["figures"];
  ASSERT_FALSE(list.empty());
  for (const auto& figure : {list.front(), list.back()}) {
    const auto svg = researcher->Get(figure["url"].get<std::string>() + "?width_mm=120");
    ASSERT_TRUE(svg);
    EXPECT_EQ(svg->status, 200);
    EXPECT_EQ(svg->get_header_value("Content-Type"), "image/svg+xml");
    EXPECT_NE(svg->body.find("width=\"120mm\""), std::string::npos);
  }
  EXPECT_EQ(error_of(researcher->Get(at + "/figures/none.svg"), 404), "not_found");
  EXPECT_EQ(error_of(researcher->Get(at + "/figures/worths.svg?set=some"), 400), "bad_value");
  EXPECT_EQ(error_of(researcher->Get(at + "/figures/worths.svg?width_mm=0"), 400), "bad_value");
}

/// Keys of an object's schema in the API's description.
std::set<std::string> described_keys(const std::string& schema) {
  std::set<std::string> keys;
  for (const auto& [name, unused] :
       api_document().at("components").at("schemas").at(schema).at("properties").items())
    keys.insert(name);
  return keys;
}

/// Cells of the only row of a table, by column; of responses.csv the first.
std::map<std::string, std::string> first_row(const std::string& text) {
  const auto records = study::parse_csv(text);
  std::map<std::string, std::string> row;
  for (std::size_t i = 0; i < records.at(0).cells.size(); ++i)
    row[records[0].cells[i]] = records.at(1).cells[i];
  return row;
}

/// What the API takes from people, by key, with the columns in which it leaves. Keys that are no
/// facts about a person or page have no column.
const std::map<std::string, std::vector<std::string>> columns_of_answer{
    {"answer_id", {}},
    {"shelves", {"shelf_0_is_most_realistic", "rank_1_is_most_realistic"}},
    {"digits", {"digit_as_typed"}},
    {"difficulty", {"difficulty_1_hard_to_see_5_easy"}},
    {"all_same", {"all_same"}},
    {"active_ms", {"active_ms"}},
    {"total_ms", {"total_ms"}},
    {"enlargements", {"enlarged"}},
    {"flips", {"flipped"}},
    {"turns", {"turns"}},
    {"frames_seen", {"frames_seen"}},
    {"swaps", {"swaps", "swapped_direction"}},
    {"blurs", {"blurs"}},
    {"load_failures", {"load_failures"}},
    {"window", {"window_width", "window_height"}},
    {"screen", {"screen_width", "screen_height"}},
    {"device_pixel_ratio", {"device_pixel_ratio"}},
    {"order_shown", {"order_shown"}},
    {"started_at", {"page_started_at"}},
    {"answered_at", {"page_answered_at"}}};

TEST_F(AStudy, ExportsEveryKeyThatItRecords) {
  std::set<std::string> keys;
  for (const auto& [key, columns] : columns_of_answer) keys.insert(key);
  EXPECT_EQ(keys, described_keys("Answer")) << "what the API takes, this test must know";
  publish();
  const auto person = enter({{"parameters", {{"PROLIFIC_PID", "pid-1"}, {"SESSION_ID", "s-1"}}}});
  auto body = answer(person["pages"][0], 1, 4);
  for (auto& shelf : body["shelves"]) shelf = 2;
  body.update({{"all_same", true},
               {"active_ms", 1201},
               {"total_ms", 1302},
               {"enlargements", 13},
               {"flips", 14},
               {"turns", 21},
               {"frames_seen", 22},
               {"swaps", 15},
               {"blurs", 16},
               {"load_failures", 17},
               {"window", {{"width", 1801}, {"height", 1802}}},
               {"screen", {{"width", 1901}, {"height", 1902}}},
               {"device_pixel_ratio", 2.625},
               {"order_shown", {8, 7, 6, 5, 4, 3, 2, 1, 0}},
               {"started_at", "2026-01-01T00:00:01Z"},
               {"answered_at", "2026-01-01T00:00:02Z"}});
  body_of(put(page_of(person, 0), answer(person["pages"][0], 9, 2)), 200, "AnswerReply");
  body_of(put(page_of(person, 0), body), 200, "AnswerReply");
  for (std::size_t page = 1; page < person["pages"].size(); ++page)
    body_of(put(page_of(person, page), answer(person["pages"][page], 20 + static_cast<int>(page))),
            200, "AnswerReply");
  const json details = {{"comment", "too dark, mostly"}, {"patches_seen", 6}};
  body_of(
      client->Post("/api/v1/participants/" + person["participant"].get<std::string>() + "/complete",
                   details.dump(), "application/json"),
      200, "Completion");
  const auto file = folder.path / "export.zip";
  std::ofstream(file, std::ios::binary) << researcher->Get(at + "/export.zip")->body;
  const auto files = unpacked(file);

  auto row = first_row(files.at("responses.csv"));
  const std::map<std::string, std::string> sent{{"shelf_0_is_most_realistic", "2"},
                                                {"rank_1_is_most_realistic", "5"},
                                                {"digit_as_typed", ""},
                                                {"difficulty_1_hard_to_see_5_easy", "4"},
                                                {"all_same", "TRUE"},
                                                {"active_ms", "1201"},
                                                {"total_ms", "1302"},
                                                {"enlarged", "13"},
                                                {"flipped", "14"},
                                                {"turns", "21"},
                                                {"frames_seen", "22"},
                                                {"swaps", "15"},
                                                {"swapped_direction", "TRUE"},
                                                {"blurs", "16"},
                                                {"load_failures", "17"},
                                                {"window_width", "1801"},
                                                {"window_height", "1802"},
                                                {"screen_width", "1901"},
                                                {"screen_height", "1902"},
                                                {"device_pixel_ratio", "2.625"},
                                                {"order_shown", "8 7 6 5 4 3 2 1 0"},
                                                {"page_started_at", "2026-01-01T00:00:01Z"},
                                                {"page_answered_at", "2026-01-01T00:00:02Z"}};
  for (const auto& [key, columns] : columns_of_answer)
    for (const auto& column : columns) {
      ASSERT_TRUE(sent.contains(column)) << column;
      ASSERT_TRUE(row.contains(column)) << key << " has no column " << column;
      EXPECT_EQ(row[column], sent.at(column)) << column;
    }
  EXPECT_EQ(row["answers_before"], "1");
  EXPECT_EQ(row["participant_completed"], "TRUE");
  EXPECT_GT(row["started_at"], "2026");
  EXPECT_EQ(first_row(files.at("earlier_responses.csv"))["difficulty_1_hard_to_see_5_easy"], "2");

  auto who = first_row(files.at("participants.csv"));
  EXPECT_EQ(described_keys("CompleteRequest"),
            (std::set<std::string>{"comment", "demographics", "patches_seen"}));
  EXPECT_EQ(who["comment"], "too dark, mostly");
  EXPECT_EQ(who["patches_seen"], "6");
  EXPECT_EQ(who["parameter.PROLIFIC_PID"], "pid-1");
  EXPECT_EQ(who["parameter.SESSION_ID"], "s-1");
  EXPECT_EQ(who["completed"], "TRUE");
  EXPECT_EQ(who["outcome"], "completed");
  EXPECT_EQ(who["language"], "en");
  EXPECT_EQ(who["place"], "0");
  EXPECT_GT(who["entered_at"], "2026");
  EXPECT_GE(who["last_seen_at"], who["entered_at"]);
}

}  // namespace
}  // namespace penumbra::server::http
