#include "study/answer.h"

#include <gmock/gmock.h>

#include "study_file.h"

namespace penumbra::study {
namespace answer_tests {

using nlohmann::json;
using ::testing::ElementsAre;

const char* const uuid = "0b7c2a58-6b1f-4c0e-9a55-9c2b1d5a7e10";

json good_answer() {
  return {{"answer_id", uuid},        {"shelves", {{"0", 0}, {"1", 2}, {"2", 0}}},
          {"difficulty", 4},          {"active_ms", 20500.5},
          {"enlargements", 3},        {"swaps", 1},
          {"order_shown", {2, 0, 1}}, {"window", {{"width", 1280}, {"height", 720}}},
          {"device_pixel_ratio", 1.5}};
}

std::string fault_of(const std::function<void(json&)>& change, bool numeric = false) {
  json document = thesis_document();
  document["widget"] = numeric ? "numeric" : "shelves";
  const Study study = parse_study(document);
  json body = good_answer();
  change(body);
  return field_at_fault([&] { parse_answer(body, study.arms.front(), 3); });
}

TEST(Answer, ShelvesAndDifficultyAreRead) {
  const Answer answer = parse_answer(good_answer(), Arm{}, 3);
  EXPECT_THAT(answer.shelves, ElementsAre(0, 2, 0));
  EXPECT_EQ(answer.difficulty, 4);
  EXPECT_EQ(answer.answer_id, uuid);
  EXPECT_EQ(answer.observations.active_ms, 20500.5);
  EXPECT_EQ(answer.observations.swaps, 1);
}

TEST(Answer, TheFieldAtFaultIsNamed) {
  EXPECT_EQ(fault_of([](json& b) { b.erase("answer_id"); }), "answer_id");
  EXPECT_EQ(fault_of([](json& b) { b["answer_id"] = "x"; }), "answer_id");
  EXPECT_EQ(fault_of([](json& b) { b.erase("shelves"); }), "shelves");
  EXPECT_EQ(fault_of([](json& b) { b["shelves"].erase("1"); }), "shelves.1");
  EXPECT_EQ(fault_of([](json& b) { b["shelves"]["1"] = 3; }), "shelves.1");
  EXPECT_EQ(fault_of([](json& b) { b["shelves"]["1"] = -1; }), "shelves.1");
  EXPECT_EQ(fault_of([](json& b) { b["shelves"]["1"] = 0.5; }), "shelves.1");
  EXPECT_EQ(fault_of([](json& b) { b["shelves"]["1"] = nullptr; }), "shelves.1");
  EXPECT_EQ(fault_of([](json& b) { b["shelves"]["3"] = 0; }), "shelves.3");
  EXPECT_EQ(fault_of([](json& b) { b["shelves"]["01"] = 0; }), "shelves.01");
  EXPECT_EQ(fault_of([](json& b) { b.erase("difficulty"); }), "difficulty");
  EXPECT_EQ(fault_of([](json& b) { b["difficulty"] = 0; }), "difficulty");
  EXPECT_EQ(fault_of([](json& b) { b["difficulty"] = 6; }), "difficulty");
  EXPECT_EQ(fault_of([](json& b) { b["difficulty"] = "4"; }), "difficulty");
  EXPECT_EQ(fault_of([](json& b) { b["digits"] = b["shelves"]; }), "digits");
  EXPECT_EQ(fault_of([](json& b) { b["name"] = "x"; }), "name");
  EXPECT_EQ(fault_of([](json& b) { b["active_ms"] = -1; }), "active_ms");
  EXPECT_EQ(fault_of([](json& b) { b["window"] = 7; }), "window");
  EXPECT_EQ(fault_of([](json& b) { b["order_shown"][1] = 3; }), "order_shown[1]");
  EXPECT_EQ(fault_of([](json& b) { b["all_same"] = true; }), "all_same");
}

TEST(Answer, ANumericStudyTakesDigitsFromOneToNine) {
  const auto with_digits = [](int digit) {
    return [digit](json& b) {
      b.erase("shelves");
      b["digits"] = {{"0", digit}, {"1", 5}, {"2", 5}};
    };
  };
  EXPECT_EQ(fault_of(with_digits(9), true), "(none)");
  EXPECT_EQ(fault_of(with_digits(0), true), "digits.0");
  EXPECT_EQ(fault_of(with_digits(10), true), "digits.0");
  EXPECT_EQ(fault_of([](json&) {}, true), "digits");
}

TEST(Answer, ThePracticePageNeedsNoDifficulty) {
  json body = good_answer();
  body.erase("difficulty");
  EXPECT_EQ(parse_answer(body, Arm{}, 3, true).difficulty, 0);
}

TEST(Answer, TheSameAnswerIsRecognisedWhateverItsNotation) {
  const json a = json::parse(R"({"answer_id":"x","difficulty":4,"shelves":{"0":1,"1":0}})");
  const json b = json::parse(R"({"shelves":{"1":0.0,"0":1},"difficulty":4.0,"answer_id":"x"})");
  const json c = json::parse(R"({"answer_id":"x","difficulty":3,"shelves":{"0":1,"1":0}})");
  EXPECT_TRUE(same_answer(a, b));
  EXPECT_FALSE(same_answer(a, c));
}

TEST(Answer, EqualPlacesShareTheMeanRank) {
  // R: 2 * rank(c(0, 2, 0, 5)) and 2 * rank(c(4, 4, 4))
  EXPECT_THAT(doubled_mid_ranks({0, 2, 0, 5}), ElementsAre(3, 6, 3, 8));
  EXPECT_THAT(doubled_mid_ranks({4, 4, 4}), ElementsAre(4, 4, 4));
  EXPECT_TRUE(doubled_mid_ranks({}).empty());
}

}  // namespace answer_tests
}  // namespace penumbra::study
