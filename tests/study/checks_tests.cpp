#include "study/checks.h"

#include <gtest/gtest.h>

#include "study_file.h"

namespace penumbra::study {
namespace checks_tests {

using nlohmann::json;

json checked_document() {
  json document = thesis_document();
  document["techniques"] = {"none", "shadow-map", "reference"};
  document["practice"] = {{"scene", "boxes"}, {"techniques", {"reference", "shadow-map", "none"}}};
  document["pages"] = {
      {{"scene", "car"}, {"expected", {{"better", "reference"}, {"worse", "none"}}}},
      {{"id", "attention"},
       {"scene", "boxes"},
       {"expected", "all_same"},
       {"question", {{"en", "Put all on one shelf."}, {"nl", "Zet alle op een plank."}}}}};
  document["repeats"] = {"car"};
  return document;
}

std::string fault_of(const std::function<void(json&)>& change) {
  json document = checked_document();
  change(document);
  return field_at_fault([&] { parse_study(document); });
}

/// An answer that puts the pictures called `ids` on shelves from the top, one each.
json ranking(const Study& study, const PlannedPage& planned, const std::vector<std::string>& ids) {
  json shelves;
  for (std::size_t slot = 0; slot < planned.slots.size(); ++slot) {
    const auto& id = page_of(study, planned).pictures[planned.slots[slot]].id;
    shelves[std::to_string(slot)] = std::find(ids.begin(), ids.end(), id) - ids.begin();
  }
  return {{"answer_id", "00000000-0000-4000-8000-000000000001"},
          {"shelves", shelves},
          {"difficulty", 3}};
}

class Checks : public ::testing::Test {
 protected:
  /// Answers to all pages, with the given orders; the attention item gets `attention`.
  PersonChecks of(const std::vector<std::string>& practice, const std::vector<std::string>& gold,
                  bool attention) const {
    std::vector<std::pair<std::size_t, json>> answers;
    for (std::size_t i = 0; i < plan.pages.size(); ++i) {
      const auto& planned = plan.pages[i];
      const bool item = planned.kind == PageKind::ranking && !page_of(study, planned).counted();
      json body = ranking(study, planned, planned.kind == PageKind::practice ? practice : gold);
      if (item && attention)
        for (auto& shelf : body["shelves"]) shelf = 1;
      answers.emplace_back(i, body);
    }
    return checks_of(study, plan, answers, {{"patches_seen", 6}});
  }

  const Study study = parse_study(checked_document());
  const EnrolmentPlan plan = plan_enrolment(study, 5, 0);
  const std::vector<std::string> right{"reference", "shadow-map", "none"};
  const std::vector<std::string> turned{"none", "shadow-map", "reference"};
};

TEST_F(Checks, TheExpectedAnswersAreMetAndLeaveNoFlag) {
  const auto checks = of(right, right, true);
  EXPECT_EQ(checks.practice_right, true);
  EXPECT_EQ(checks.patches_seen, 6);
  EXPECT_EQ(checks.failures(), 0);
  ASSERT_EQ(checks.pages.size(), 3u);
  EXPECT_TRUE(check_flags(study, "p", checks).empty());
  EXPECT_EQ(checked_pages(study), (std::vector<std::string>{"car", "attention", "car.again"}));
}

TEST_F(Checks, EveryFailureIsCountedAndFlaggedByItsKind) {
  const auto checks = of(turned, turned, false);
  EXPECT_EQ(checks.practice_right, false);
  EXPECT_EQ(checks.failures(), 3);  // the gold page twice, the attention item once
  const auto flags = check_flags(study, "p", checks);
  ASSERT_EQ(flags.size(), 2u);
  EXPECT_EQ(flags[0].name, "attention");
  EXPECT_EQ(flags[0].value, 1.0);
  EXPECT_EQ(flags[1].name, "gold");
  EXPECT_EQ(flags[1].value, 2.0);
  EXPECT_FALSE(is_screened_out(study, checks)) << "the consequence is a flag unless the study asks";
}

TEST_F(Checks, ThePracticePageIsRightWithItsBestBeforeItsWorst) {
  const auto& planned = plan.pages.front();
  std::vector<int> shelves(3);
  const auto order = [&](int reference, int map, int none) {
    const std::vector<int> by_picture{reference, map, none};
    for (std::size_t slot = 0; slot < 3; ++slot) shelves[slot] = by_picture[planned.slots[slot]];
    return practice_is_right(planned, shelves);
  };
  EXPECT_TRUE(order(0, 1, 2));
  EXPECT_TRUE(order(0, 0, 1));
  EXPECT_TRUE(order(0, 2, 2));
  EXPECT_FALSE(order(0, 0, 0));
  EXPECT_FALSE(order(1, 0, 2));
  EXPECT_FALSE(order(0, 2, 1));
}

TEST_F(Checks, TheStudyEndsForAPersonBeyondTheAllowedFailures) {
  for (const int allowed : {0, 2, 3}) {
    json document = checked_document();
    document["expectations"] = {{"allowed_failures", allowed}, {"consequence", "screen_out"}};
    const Study strict = parse_study(document);
    EXPECT_EQ(is_screened_out(strict, of(right, turned, false)), allowed < 3) << allowed;
    EXPECT_FALSE(is_screened_out(strict, of(right, right, true)));
  }
}

TEST_F(Checks, ADimScreenIsFlaggedOrEndsTheStudy) {
  json document = checked_document();
  document["brightness"] = {{"minimum_patches", 7}};
  const auto checks = of(right, right, true);
  const auto flags = check_flags(parse_study(document), "p", checks);
  ASSERT_EQ(flags.size(), 1u);
  EXPECT_EQ(flags[0].name, "dim_screen");
  EXPECT_FALSE(is_screened_out(parse_study(document), checks));
  document["brightness"]["consequence"] = "screen_out";
  EXPECT_TRUE(is_screened_out(parse_study(document), checks));
  document["brightness"]["minimum_patches"] = 6;
  EXPECT_FALSE(is_screened_out(parse_study(document), checks));
}

TEST(CheckedStudies, FaultsAreNamedByTheirPath) {
  EXPECT_EQ(fault_of([](json&) {}), "(none)");
  EXPECT_EQ(fault_of([](json& d) { d["pages"][0]["expected"]["better"] = "pcss"; }),
            "pages[0].expected.better");
  EXPECT_EQ(fault_of([](json& d) { d["pages"][0]["expected"]["worse"] = "reference"; }),
            "pages[0].expected.worse");
  EXPECT_EQ(fault_of([](json& d) { d["pages"][1].erase("question"); }), "pages[1].question");
  EXPECT_EQ(fault_of([](json& d) { d["repeats"] = {"attention"}; }), "repeats[0]");
  EXPECT_EQ(fault_of([](json& d) {
              d["brightness"] = {{"minimum_patches", 9}};
            }),
            "brightness.minimum_patches");
  EXPECT_EQ(fault_of([](json& d) { d["person_parameter"] = "SOMEONE"; }), "person_parameter");
}

TEST(CheckedStudies, TheParameterThatNamesAPersonIsNoStudyOrSession) {
  const auto named = [](const json& parameters) {
    json document = thesis_document();
    document["id_parameters"] = parameters;
    return parse_study(document).person_parameter;
  };
  EXPECT_EQ(named({"STUDY_ID", "PROLIFIC_PID"}), "PROLIFIC_PID");
  EXPECT_EQ(named({"hitId", "assignmentId", "workerId"}), "workerId");
  EXPECT_EQ(named({"STUDY_ID", "pid"}), "pid");
  EXPECT_EQ(named({"STUDY_ID", "SESSION_ID"}), "");
  EXPECT_EQ(named(json::array()), "");
}

}  // namespace checks_tests
}  // namespace penumbra::study
