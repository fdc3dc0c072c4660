#include "study/responses.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "study/csv.h"
#include "study_file.h"

namespace penumbra::study {
namespace responses_tests {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string least_header =
    "participant,scene,technique,rank_1_is_most_realistic,difficulty_1_hard_to_see_5_easy\n";

/// Message of the failure to parse, empty where there is none.
std::string complaint(const std::string& text) {
  try {
    parse_responses(text);
  } catch (const Error& error) {
    return error.field + ": " + error.what();
  }
  return {};
}

TEST(Responses, TheContractsColumnsAloneAreEnoughInAnyOrder) {
  const auto rows = parse_responses(
      "scene,participant,rank_1_is_most_realistic,difficulty_1_hard_to_see_5_easy,technique,mood\n"
      "car,P1,1.5,4,shadow-map,fine\n"
      "\n"
      "car,P1,1.5,,pcss,\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].participant, "P1");
  EXPECT_EQ(rows[0].technique, "shadow-map");
  EXPECT_DOUBLE_EQ(rows[0].rank, 1.5);
  EXPECT_EQ(rows[0].difficulty, 4);
  EXPECT_FALSE(rows[1].difficulty.has_value());
  EXPECT_TRUE(rows[1].included);
  EXPECT_EQ(rows[1].repeat, 0);
}

TEST(Responses, FaultsAreNamedByLineAndColumn) {
  EXPECT_THAT(complaint(""), HasSubstr("no header"));
  EXPECT_THAT(complaint("participant,scene\nP1,car\n"), HasSubstr("technique"));
  EXPECT_THAT(complaint(least_header + "P1,car,a,1,3\nP1,car,b,first,3\n"),
              HasSubstr("rank_1_is_most_realistic: line 3, column rank_1_is_most_realistic"));
  EXPECT_THAT(complaint(least_header + "P1,car,a,nan,3\n"), HasSubstr("rank_1_is_most_realistic"));
  EXPECT_THAT(complaint(least_header + "P1,car,a,1,6\n"),
              HasSubstr("line 2, column difficulty_1_hard_to_see_5_easy"));
  EXPECT_THAT(complaint(least_header + "P1,car,a,1\n"), HasSubstr("line 2: 4 cells"));
  EXPECT_THAT(complaint(least_header + ",car,a,1,3\n"), HasSubstr("participant: line 2"));
  EXPECT_THAT(complaint(least_header + "P1,car,a,1,3\nP1,car,a,2,3\n"),
              HasSubstr("line 3, column technique"));
  EXPECT_THAT(complaint(least_header + "\"P1,car,a,1,3\n"), HasSubstr("line 2: a quote never"));
  EXPECT_THAT(complaint(least_header + "P\xff,car,a,1,3\n"), HasSubstr("line 2: not UTF-8"));
  EXPECT_THAT(complaint(least_header + "\"P\"1,car,a,1,3\n"), HasSubstr("line 2"));
}

/// The same answers as a spreadsheet of a country with decimal commas saves them.
TEST(Responses, SemicolonsTabsAndDecimalCommasOfSpreadsheetsAreRead) {
  const std::string commas =
      least_header + "P1,\"car, red\",a,1.5,4\nP1,\"car, red\",b,1.5,4\nP1,\"car, red\",c,3,\n";
  const auto expected = parse_responses(commas);
  for (const char separator : {';', '\t'}) {
    std::string text =
        least_header + "P1,car| red,a,1|5,4\nP1,car| red,b,1|5,4\nP1,car| red,c,3,\n";
    std::replace(text.begin(), text.end(), ',', separator);
    std::replace(text.begin(), text.end(), '|', ',');
    for (const auto given : {std::optional<char>(), std::optional<char>(separator)}) {
      std::vector<ResponseRow> rows;
      const auto format = each_response(
          text, [&](const ResponseRow& row) { rows.push_back(row); }, given);
      EXPECT_EQ(format.separator, separator);
      ASSERT_EQ(rows.size(), 3u);
      EXPECT_EQ(write_responses(rows), write_responses(expected));
    }
  }
  EXPECT_THAT(complaint("participant;scene;technique\nP1;car;a\n"),
              HasSubstr("it holds `participant;scene;technique`"));
  EXPECT_THAT(complaint(least_header + "P1,car,a,\"1,5\",3\n"), HasSubstr("found `1,5`"));
}

TEST(Responses, CellsThatASpreadsheetWouldRunAreNeutralised) {
  EXPECT_EQ(csv_text("=1+1"), "'=1+1");
  EXPECT_EQ(csv_text("+1"), "'+1");
  EXPECT_EQ(csv_text("-1"), "'-1");
  EXPECT_EQ(csv_text("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(csv_text("\tx"), "'\tx");
  EXPECT_EQ(csv_text(std::string_view("\0x", 2)), std::string("'\0x", 3));
  EXPECT_EQ(csv_text(" =1"), "' =1");
  EXPECT_EQ(csv_text("   @x"), "'   @x");
  EXPECT_EQ(csv_text("\n=1"), "\"'\n=1\"");
  EXPECT_EQ(csv_text("\r\n=1"), "\"'\r\n=1\"");
  EXPECT_EQ(csv_text("\xEF\xBC\x9D"
                     "1"),
            "'\xEF\xBC\x9D"
            "1")
      << "U+FF1D, a wide equals sign";
  EXPECT_EQ(csv_text("a=b"), "a=b");
  EXPECT_EQ(csv_text(" a"), " a");
  EXPECT_EQ(csv_text("\xEF\xBC\x81"), "\xEF\xBC\x81") << "U+FF01, a wide exclamation mark";
}

TEST(Responses, CellsAreQuotedAsRfc4180Says) {
  EXPECT_EQ(csv_text("plain"), "plain");
  EXPECT_EQ(csv_text("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_text("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(csv_text("two\nlines"), "\"two\nlines\"");
  const auto records = parse_csv("a,\"b,\"\"c\"\"\r\nd\"\r\ne,\r\n");
  ASSERT_EQ(records.size(), 2u);
  EXPECT_THAT(records[0].cells, ElementsAre("a", "b,\"c\"\r\nd"));
  EXPECT_THAT(records[1].cells, ElementsAre("e", ""));
  EXPECT_EQ(records[1].line, 3u);
}

TEST(Responses, WhatIsWrittenIsReadBack) {
  ResponseRow row;
  row.study = "s";
  row.participant = "=cmd|' /C calc'!A0";
  row.page_index = 3;
  row.repeat = 1;
  row.scene = "caf\xc3\xa9, \"left\"";
  row.technique = "-pcss";
  row.slot = 0;
  row.rank = 2.5;
  row.shelf = 1;
  row.difficulty = 5;
  row.weight = 0.1;
  row.active_ms = 1234.5;
  row.swapped_direction = true;
  row.flags = "fast flat";
  row.included = false;
  const auto back = parse_responses("\xEF\xBB\xBF" + write_responses({row}));
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].participant, row.participant);
  EXPECT_EQ(back[0].page_index, 3);
  EXPECT_EQ(back[0].repeat, 1);
  EXPECT_EQ(back[0].scene, row.scene);
  EXPECT_EQ(back[0].technique, row.technique);
  EXPECT_EQ(back[0].slot, 0);
  EXPECT_DOUBLE_EQ(back[0].rank, 2.5);
  EXPECT_EQ(back[0].shelf, 1);
  EXPECT_FALSE(back[0].digit.has_value());
  EXPECT_EQ(back[0].weight, 0.1);
  EXPECT_EQ(back[0].active_ms, 1234.5);
  EXPECT_EQ(back[0].swapped_direction, true);
  EXPECT_EQ(back[0].flags, "fast flat");
  EXPECT_FALSE(back[0].included);
}

TEST(Responses, AnAnswerBecomesOneRowPerPictureWithMidRanks) {
  const Study study = parse_study(thesis_document());
  // The last of the study's pictures, its reference, then five others; the first one last.
  const std::size_t last = study.pages[1].pictures.size() - 1;
  const PlannedPage planned{PageKind::repeat, 1, {last, 4, 3, 2, 1, 0}};
  Answer answer;
  answer.shelves = {0, 0, 1, 2, 2, 2};
  answer.order = answer.shelves;
  answer.difficulty = 2;
  answer.observations.swaps = 1;
  const auto rows =
      response_rows(study, "hash", "P1", {}, planned, 4, answer, "2026-01-01T00:00:00Z");
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0].technique, "reference");
  EXPECT_EQ(rows[5].technique, "shadow-map");
  // R: rank(c(0, 0, 1, 2, 2, 2)) is 1.5 1.5 3.0 5.0 5.0 5.0
  std::vector<double> ranks;
  for (const ResponseRow& row : rows) ranks.push_back(row.rank);
  EXPECT_THAT(ranks, ElementsAre(1.5, 1.5, 3.0, 5.0, 5.0, 5.0));
  EXPECT_EQ(rows[0].scene, "boxes");
  EXPECT_EQ(rows[0].repeat, 1);
  EXPECT_EQ(rows[0].page_index, 4);
  EXPECT_EQ(rows[0].weight, 2.0);
  EXPECT_EQ(rows[0].swapped_direction, true);
}

}  // namespace responses_tests
}  // namespace penumbra::study
