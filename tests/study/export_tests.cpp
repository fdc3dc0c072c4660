#include "study/export_tables.h"

#include <gmock/gmock.h>

#include <set>

#include "study/csv.h"
#include "study/simulate.h"
#include "study_file.h"

namespace penumbra::study {
namespace export_tests {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

ResponseRow row_of(const std::string& participant, const std::string& technique, double rank) {
  ResponseRow row;
  row.participant = participant;
  row.scene = "car";
  row.technique = technique;
  row.rank = rank;
  return row;
}

std::vector<std::vector<std::string>> cells_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& record : parse_csv(text)) rows.push_back(record.cells);
  return rows;
}

TEST(Pairs, HoldEveryPairOnceAsPwcmpReadsIt) {
  // pw_scale_table(T, 'scene', {'A','B'}, 'observer', 'selected'): 1 where A was selected,
  // otherwise 0.
  PairsTable table;
  std::string text = PairsTable::header();
  table.append({row_of("P1", "c", 3), row_of("P1", "a", 1), row_of("P1", "b", 2)}, text);
  const auto rows = cells_of(text);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_THAT(rows[0], ElementsAre("observer", "session", "scene", "A", "B", "selected", "tie"));
  EXPECT_THAT(rows[1], ElementsAre("P1", "1", "car", "a", "b", "1", "FALSE"));
  EXPECT_THAT(rows[2], ElementsAre("P1", "1", "car", "a", "c", "1", "FALSE"));
  EXPECT_THAT(rows[3], ElementsAre("P1", "1", "car", "b", "c", "1", "FALSE"));
}

TEST(Pairs, TiesAreHalfWinsInTheSum) {
  PairsTable table;
  std::string text = PairsTable::header();
  for (const char* person : {"P1", "P2", "P3", "P4"})
    table.append({row_of(person, "a", 1.5), row_of(person, "b", 1.5)}, text);
  int selected = 0;
  for (const auto& row : cells_of(text)) {
    if (row[0] == "observer") continue;
    EXPECT_EQ(row[6], "TRUE");
    selected += row[5] == "1" ? 1 : 0;
  }
  EXPECT_EQ(selected, 2);
}

TEST(Pairs, SecondShowingsAndPeopleTakenOutAreLeftOut) {
  PairsTable table;
  std::string text;
  auto again = std::vector<ResponseRow>{row_of("P1", "a", 1), row_of("P1", "b", 2)};
  for (auto& row : again) row.repeat = 1;
  table.append(again, text);
  auto gone = std::vector<ResponseRow>{row_of("P2", "a", 1), row_of("P2", "b", 2)};
  for (auto& row : gone) row.included = false;
  table.append(gone, text);
  EXPECT_EQ(text, "");
}

TEST(Wide, HasARowPerPersonAndTheRankOfEveryPicture) {
  const Study study = parse_study(thesis_document());
  const auto rows =
      simulate_responses(study, simulate_people(1, 0, 0, 3), default_preferences(study), 3);
  const WideTable table(study);
  std::string text = table.header();
  table.append({rows}, text);
  const auto records = cells_of(text);
  ASSERT_EQ(records.size(), 2u);
  ASSERT_EQ(records[0].size(), records[1].size());
  std::map<std::string, std::string> value;
  for (std::size_t i = 0; i < records[0].size(); ++i) value[records[0][i]] = records[1][i];
  for (const ResponseRow& row : rows) {
    EXPECT_DOUBLE_EQ(std::stod(value.at(row.scene + "." + row.technique)), row.rank);
    EXPECT_EQ(value.at(row.scene + ".difficulty"), std::to_string(*row.difficulty));
  }
  EXPECT_EQ(value.at("included"), "TRUE");
}

TEST(ParticipantsFile, IsFlatAndNeutralised) {
  auto document = thesis_document();
  document["demographics"] = {{{"id", "games"},
                               {"question", {{"en", "Games?"}, {"nl", "Spelen?"}}},
                               {"options",
                                {{{"id", "yes"}, {"text", {{"en", "Yes"}, {"nl", "Ja"}}}},
                                 {{"id", "no"}, {"text", {{"en", "No"}, {"nl", "Nee"}}}}}}}};
  const ParticipantsTable table(parse_study(document));
  ParticipantRow person;
  person.participant = "P1";
  person.excluded = true;
  person.exclusion_reason = "=cmd|' /C calc'!A0";
  person.flags = "fast flat";
  person.parameters = {{"PROLIFIC_PID", "@x"}};
  person.details = {{"demographics", {{"games", "yes"}}}, {"comment", "=1+1"}};
  person.checks.patches_seen = 6;
  std::string text = table.header();
  table.append(person, text);
  const auto rows = cells_of(text);
  std::map<std::string, std::string> value;
  ASSERT_EQ(rows[0].size(), rows[1].size());
  for (std::size_t i = 0; i < rows[0].size(); ++i) value[rows[0][i]] = rows[1][i];
  EXPECT_EQ(value.at("completed"), "FALSE");
  EXPECT_EQ(value.at("excluded"), "TRUE");
  EXPECT_EQ(value.at("exclusion_reason"), "'=cmd|' /C calc'!A0");
  EXPECT_EQ(value.at("parameter.PROLIFIC_PID"), "'@x");
  EXPECT_EQ(value.at("answer.games"), "yes");
  EXPECT_EQ(value.at("comment"), "'=1+1");
  EXPECT_EQ(value.at("patches_seen"), "6");
  EXPECT_EQ(value.at("practice_right"), "");
  EXPECT_EQ(value.at("flags"), "fast flat");
}

TEST(Codebook, ExplainsEveryColumnOfEveryTable) {
  const Study study = parse_study(thesis_document());
  std::set<std::pair<std::string, std::string>> explained;
  for (const auto& row : cells_of(write_codebook(study))) {
    ASSERT_EQ(row.size(), 4u);
    EXPECT_GT(row[3].size(), 4u) << row[0] << " " << row[1];
    EXPECT_TRUE(explained.emplace(row[0], row[1]).second) << row[0] << " " << row[1];
  }
  const std::map<std::string, std::string> headers{
      {"responses.csv", response_header()},
      {"responses_wide.csv", WideTable(study).header()},
      {"pairs.csv", PairsTable::header()},
      {"participants.csv", ParticipantsTable(study).header()}};
  for (const auto& [file, header] : headers) {
    const auto rows = cells_of(header);
    for (const auto& name : rows.front())
      EXPECT_TRUE(explained.contains({file, name})) << file << " " << name;
  }
  for (const char* file : {"report.html", "results.json", "results.tex", "study.json",
                           "responses.json", "recompute.R", "recompute.py", "figures/*.svg"})
    EXPECT_TRUE(explained.contains({file, ""})) << file;
}

TEST(Responses, WhatThePageNotedIsExported) {
  const Study study = parse_study(thesis_document());
  nlohmann::json body = {{"answer_id", "00000000-0000-4000-8000-000000000001"},
                         {"shelves", nlohmann::json::object()},
                         {"difficulty", 3},
                         {"blurs", 2},
                         {"load_failures", 1},
                         {"swaps", 3},
                         {"order_shown", {2, 0, 1}},
                         {"window", {{"width", 1280}, {"height", 720.5}}},
                         {"screen", {{"width", 1920}, {"height", 1080}}},
                         {"device_pixel_ratio", 1.25},
                         {"started_at", "2026-01-01T10:00:00Z"},
                         {"answered_at", "2026-01-01T10:01:00Z"}};
  const PlannedPage planned{PageKind::ranking, 0, {0, 1, 2, 3, 4, 5, 6, 7, 8}};
  for (int i = 0; i < 9; ++i) body["shelves"][std::to_string(i)] = i;
  auto rows =
      response_rows(study, "h", "P1", {}, planned, 0, parse_answer(body, {}, 9), "2026-01-01");
  const auto cells = cells_of(write_responses(rows));
  std::map<std::string, std::string> value;
  for (std::size_t i = 0; i < cells[0].size(); ++i) value[cells[0][i]] = cells[1][i];
  EXPECT_EQ(value.at("blurs"), "2");
  EXPECT_EQ(value.at("load_failures"), "1");
  EXPECT_EQ(value.at("swaps"), "3");
  EXPECT_EQ(value.at("swapped_direction"), "TRUE");
  EXPECT_EQ(value.at("order_shown"), "2 0 1");
  EXPECT_EQ(value.at("window_width"), "1280");
  EXPECT_EQ(value.at("window_height"), "720.5");
  EXPECT_EQ(value.at("screen_height"), "1080");
  EXPECT_EQ(value.at("device_pixel_ratio"), "1.25");
  EXPECT_EQ(value.at("page_started_at"), "2026-01-01T10:00:00Z");
  EXPECT_EQ(value.at("participant_completed"), "FALSE");
  EXPECT_EQ(value.at("included"), "TRUE");
  EXPECT_EQ(parse_responses(write_responses(rows)).size(), 9u);
}

}  // namespace export_tests
}  // namespace penumbra::study
