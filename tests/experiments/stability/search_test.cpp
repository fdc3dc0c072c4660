// The search for the first value that breaks, over errors that are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/stability/search.h"

namespace penumbra::experiments::stability {
namespace {

using testing::HasSubstr;

Axis axis_of(std::vector<double> values, bool whole = false) {
  return {"length", "a length", "m", std::move(values), {}, whole, {}};
}

Step drawn(double value, double rms) {
  Step step;
  step.value = value;
  step.verdict.judged = 1000;
  step.verdict.shadowed = 200;
  step.verdict.lit = 800;
  step.verdict.visibility_rms = rms;
  step.verdict.missing_shadow = rms * rms * 1000;
  return step;
}

TEST(Search, halves_the_interval_around_a_known_break) {
  int calls = 0;
  const Finding finding = search("t", axis_of({1.0, 1e2, 1e4, 1e6}), [&](double value) {
    ++calls;
    return drawn(value, value < 2500.0 ? 0.01 : 0.5);
  });
  ASSERT_TRUE(finding.ends && finding.holds);
  EXPECT_LT(*finding.holds, 2500.0);
  EXPECT_GE(*finding.ends, 2500.0);
  // Two decades halved three times: a factor of 10^(1/4).
  EXPECT_NEAR(*finding.ends / *finding.holds, std::pow(10.0, 0.25), 1e-9);
  EXPECT_EQ(calls, 6);
  EXPECT_THAT(finding.cause, HasSubstr("of the shadow"));
}

TEST(Search, finds_a_count_that_breaks_between_counts_that_hold) {
  const Finding finding = search("t", axis_of({1, 255, 256, 257}, true), [](double value) {
    return drawn(value, value == 256.0 ? 0.3 : 0.0);
  });
  EXPECT_EQ(finding.ends, 256.0);
  EXPECT_EQ(finding.holds, 255.0);
  EXPECT_EQ(finding.steps.size(), 3u);
}

TEST(Search, takes_twice_the_gentle_error_and_never_less_than_a_fiftieth) {
  const auto last_error = [](double gentle, double last) {
    return search("t", axis_of({1.0, 10.0}),
                  [&](double value) { return drawn(value, value == 1.0 ? gentle : last); })
        .ends.has_value();
  };
  EXPECT_FALSE(last_error(0.0, 0.0199));
  EXPECT_TRUE(last_error(0.0, 0.0201));
  EXPECT_FALSE(last_error(0.05, 0.099));
  EXPECT_TRUE(last_error(0.05, 0.101));
}

TEST(Search, sees_a_lamp_that_went_out_though_visibility_is_right) {
  const Finding finding = search("t", axis_of({1.0, 10.0, 100.0}, true), [](double value) {
    Step step = drawn(value, 0.0);
    step.verdict.dark = value > 50.0 ? 400 : 0;
    return step;
  });
  ASSERT_TRUE(finding.ends);
  EXPECT_GT(*finding.ends, 50.0);
  EXPECT_THAT(finding.cause, HasSubstr("50% of the lit pixels"));
  EXPECT_EQ(finding.guard, "none");
}

TEST(Search, tells_a_typed_error_from_one_that_names_nothing_and_from_a_crash) {
  const auto at_ten = [](State state) {
    return search("t", axis_of({1.0, 10.0}, true), [&](double value) {
      Step step = drawn(value, 0.0);
      if (value == 1.0) return step;
      step.state = value == 10.0 ? state : State::drawn;
      step.code = "unsupported";
      step.field = "map_size";
      step.message = "too large";
      return step;
    });
  };
  EXPECT_TRUE(at_ten(State::refused).refused);
  EXPECT_EQ(at_ten(State::refused).guard, "error unsupported, field map_size");
  for (const State state : {State::opaque, State::crashed, State::hung}) {
    const Finding finding = at_ten(state);
    EXPECT_EQ(finding.ends, 10.0);
    EXPECT_FALSE(finding.refused);
    EXPECT_THAT(finding.cause, HasSubstr("too large"));
    EXPECT_EQ(finding.guard, "none");
  }
}

TEST(Search, tells_notes_that_the_gentle_step_does_not_have) {
  const Finding finding = search("t", axis_of({1.0, 10.0}, true), [](double value) {
    Step step = drawn(value, value > 9.0 ? 0.4 : 0.0);
    step.notes = {"always"};
    if (value > 9.0) step.notes.push_back("coordinates are coarse");
    return step;
  });
  EXPECT_EQ(finding.guard, "note: coordinates are coarse");
}

TEST(Search, keeps_every_number_of_a_step_in_json) {
  Step step = drawn(0.1, 0.25);
  step.state = State::refused;
  step.code = "unsupported";
  step.field = "far";
  step.message = "no \"far\"";
  step.notes = {"a", "b"};
  step.verdict.non_finite = 7;
  step.verdict.dark = 3;
  step.seconds = 1.5;
  const auto text = to_json(step).dump();
  EXPECT_EQ(to_json(step_from_json(nlohmann::json::parse(text))).dump(), text);
}

}  // namespace
}  // namespace penumbra::experiments::stability
