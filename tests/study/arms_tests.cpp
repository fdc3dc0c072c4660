// Several ways of giving ranks in one study: who gets which, and what is made of the answers.
#include "study/statistics/arms.h"

#include <gmock/gmock.h>

#include <map>
#include <set>

#include "study/statistics/distributions.h"
#include "study/statistics/report.h"
#include "study_file.h"
#include "survey_rows.h"

namespace penumbra::study {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

const json three_arms = {{{"id", "one"}, {"widget", "numeric"}},
                         {{"id", "nine"}, {"widget", "numeric"}, {"best_digit", 9}},
                         {{"id", "shelves"}, {"widget", "shelves"}}};

json document_with(const json& arms) {
  json document = thesis_document();
  document.erase("widget");
  document["arms"] = arms;
  return document;
}

TEST(Arms, AreAssignedInEqualNumbersAndInNoFixedOrder) {
  const Study study = parse_study(document_with(three_arms));
  std::vector<int> people(3, 0);
  std::set<std::vector<std::size_t>> orders;
  std::vector<std::size_t> block;
  for (std::size_t place = 0; place < 300; ++place) {
    const auto plan = plan_enrolment(study, 11, place);
    ++people[plan.arm];
    block.push_back(plan.arm);
    const auto [low, high] = std::minmax_element(people.begin(), people.end());
    ASSERT_LE(*high - *low, 1) << place;
    if (block.size() < 3) continue;
    orders.insert(block);
    block.clear();
  }
  EXPECT_EQ(orders.size(), 6u) << "100 blocks hold every order of three arms";
}

TEST(Arms, ShowTheSameOrdersAndBalanceEachOfThem) {
  const Study study = parse_study(document_with(three_arms));
  std::vector<std::vector<std::vector<std::size_t>>> shown(3);
  std::map<std::vector<std::size_t>, int> counts;  // (arm, picture, slot) of the first page
  for (std::size_t place = 0; place < 3 * 18; ++place) {
    const auto plan = plan_enrolment(study, 5, place);
    for (const auto& planned : plan.pages) {
      shown[plan.arm].push_back(planned.slots);
      if (planned.page == 0)
        for (std::size_t slot = 0; slot < 9; ++slot)
          ++counts[{plan.arm, planned.slots[slot], slot}];
    }
  }
  EXPECT_EQ(shown[0], shown[1]);
  EXPECT_EQ(shown[0], shown[2]);
  ASSERT_EQ(counts.size(), 3u * 9u * 9u);
  for (const auto& [cell, count] : counts) EXPECT_EQ(count, 2);
}

TEST(Arms, AStudyWithoutThemIsPlannedAsBefore) {
  json shelves = thesis_document();
  json digits = shelves;
  digits["widget"] = "numeric";
  digits["best_digit"] = 9;
  for (std::size_t place = 0; place < 20; ++place) {
    const auto plan = plan_enrolment(parse_study(digits), 3, place);
    EXPECT_EQ(plan.arm, 0u);
    EXPECT_EQ(plan.pages.at(2).slots,
              plan_enrolment(parse_study(shelves), 3, place).pages.at(2).slots);
  }
}

TEST(Arms, FaultsAreNamedByTheirPath) {
  const auto fault = [](const json& document) {
    return field_at_fault([&] { parse_study(document); });
  };
  EXPECT_EQ(fault(document_with(three_arms)), "(none)");
  json document = document_with(three_arms);
  document["widget"] = "shelves";
  EXPECT_EQ(fault(document), "widget");
  document = document_with(three_arms);
  document["arms"][1]["best_digit"] = 5;
  EXPECT_EQ(fault(document), "arms[1].best_digit");
  document["arms"][1] = {{"id", "one"}, {"widget", "shelves"}};
  EXPECT_EQ(fault(document), "arms[1].id");
  document["arms"][1] = {{"id", "two"}, {"widget", "shelves"}, {"best_digit", 9}};
  EXPECT_EQ(fault(document), "arms[1].best_digit");
  document["arms"] = json::array({three_arms[0]});
  EXPECT_EQ(fault(document), "arms");
  document = thesis_document();
  document["best_digit"] = 9;
  EXPECT_EQ(fault(document), "best_digit") << "shelves have no digits";
}

TEST(Arms, NineForTheBestIsReadFromTheTop) {
  const json body = {{"answer_id", "0b7c2a58-6b1f-4c0e-9a55-9c2b1d5a7e10"},
                     {"digits", {{"0", 9}, {"1", 2}, {"2", 7}}},
                     {"difficulty", 3}};
  const Arm nine{"nine", Widget::numeric, 9};
  const Answer answer = parse_answer(body, nine, 3);
  EXPECT_THAT(answer.digits, ElementsAre(9, 2, 7));
  EXPECT_THAT(answer.order, ElementsAre(1, 8, 3));
  json document = document_with(three_arms);
  document["techniques"] = {"a", "b", "c"};
  const PlannedPage planned{PageKind::ranking, 0, {2, 0, 1}};
  const auto rows = response_rows(parse_study(document), "h", "P", nine, planned, 0, answer, "");
  std::map<std::string, double> rank;
  for (const auto& row : rows) {
    rank[row.technique] = row.rank;
    EXPECT_EQ(row.arm, "nine");
    EXPECT_EQ(row.best_digit, 9);
  }
  EXPECT_EQ(rank, (std::map<std::string, double>{{"c", 1.0}, {"b", 2.0}, {"a", 3.0}}));
  EXPECT_EQ(rows[0].digit, 9);
  const auto again = parse_responses(write_responses(rows));
  EXPECT_EQ(again[1].best_digit, 9);
  EXPECT_EQ(again[1].arm, "nine");
}

TEST(Arms, MeansOfDigitsCountFromTheBest) {
  // Two pictures, 7 and 4 where 9 is best: counted from the best 3 and 6.
  std::vector<ResponseRow> rows;
  for (int person = 0; person < 3; ++person)
    for (const auto& [name, rank, digit] : {std::tuple{"a", 1.0, 7}, std::tuple{"b", 2.0, 4}}) {
      rows.push_back(row_of(person_name(static_cast<std::size_t>(person)), "s", name, rank));
      rows.back().digit = digit;
      rows.back().best_digit = 9;
    }
  const json report = statistics_report(rows, {});
  const json& means = report["included_sets"]["all"]["scenes"][0]["techniques"];
  EXPECT_EQ(means[0]["technique"], "a");
  EXPECT_DOUBLE_EQ(means[0]["mean_rank"].get<double>(), 3.0);
  EXPECT_DOUBLE_EQ(means[1]["mean_rank"].get<double>(), 6.0);
  EXPECT_FALSE(report.contains("arms"));
}

/// People with one clear order of five pictures on three pages; the first `inverted` of an arm have
/// it backwards.
void add_people(const std::string& arm, int people, int inverted, std::vector<ResponseRow>& rows) {
  for (int person = 0; person < people; ++person)
    for (int page = 0; page < 3; ++page)
      for (int i = 0; i < 5; ++i) {
        const double place = person < inverted ? 5 - i : 1 + i;
        rows.push_back(row_of(arm + std::to_string(100 + person), "s" + std::to_string(page),
                              std::string(1, static_cast<char>('a' + i)), place));
        rows.back().arm = arm;
      }
}

TEST(Arms, AreComparedByHowManyReadTheScaleRight) {
  std::vector<ResponseRow> rows;
  add_people("nine", 20, 0, rows);
  add_people("one", 20, 6, rows);
  add_people("shelves", 61, 6, rows);
  const json arms = statistics_report(rows, {})["arms"];
  ASSERT_EQ(arms["list"].size(), 3u);
  const json& one = arms["list"][1];
  EXPECT_EQ(one["arm"], "one");
  EXPECT_EQ(one["participants"], 20);
  EXPECT_EQ(one["inverted"], 6);
  EXPECT_DOUBLE_EQ(one["read_right"].get<double>(), 0.7);
  // R: binom.test(20, 20)$conf.int and binom.test(55, 61)$conf.int.
  EXPECT_NEAR(arms["list"][0]["ci95"][0].get<double>(), 0.831566529017, 1e-9);
  EXPECT_DOUBLE_EQ(arms["list"][0]["ci95"][1].get<double>(), 1.0);
  EXPECT_NEAR(arms["list"][2]["ci95"][0].get<double>(), 0.798103808146, 1e-9);
  EXPECT_NEAR(arms["list"][2]["ci95"][1].get<double>(), 0.963040005122, 1e-9);
  // 14 of 20 in order, 6 backwards: the mean rank of the best is (14 * 1 + 6 * 5) / 20.
  EXPECT_EQ(one["techniques"][0]["technique"], "a");
  EXPECT_DOUBLE_EQ(one["techniques"][0]["mean_rank"].get<double>(), 2.2);
  EXPECT_EQ(arms["comparisons"][0]["a"], "nine");
  EXPECT_EQ(arms["comparisons"][0]["b"], "one");
  EXPECT_NEAR(arms["comparisons"][0]["difference"].get<double>(), 0.3, 1e-12);
  EXPECT_NEAR(arms["comparisons"][0]["p_value"].get<double>(), 0.020196020196, 1e-9);
  EXPECT_NEAR(arms["comparisons"][0]["p_holm"].get<double>(), 3 * 0.020196020196, 1e-9);
}

TEST(FishersTest, GivesWhatRGives) {
  using statistics::fisher_exact;
  EXPECT_NEAR(fisher_exact(3, 1, 1, 3), 0.485714285714, 1e-10);  // Fisher's tea
  EXPECT_NEAR(fisher_exact(58, 3, 50, 11), 0.043638335372, 1e-10);
  EXPECT_NEAR(fisher_exact(20, 0, 14, 6), 0.020196020196, 1e-10);
  EXPECT_NEAR(fisher_exact(7, 12, 0, 5), 0.272068511199, 1e-10);
  EXPECT_DOUBLE_EQ(fisher_exact(0, 5, 0, 7), 1.0);
}

}  // namespace
}  // namespace penumbra::study
