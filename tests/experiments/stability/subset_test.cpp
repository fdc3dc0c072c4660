// A few techniques on a few axes, drawn and judged: what holds to an extreme must go on holding,
// and breaks that the method requires must not move towards gentle.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "experiments/stability/drawing.h"

namespace penumbra::experiments::stability {
namespace {

Drawing& drawing() {
  static Drawing shared({.device = "", .validation = true});
  return shared;
}

Axis axis_of(const std::string& technique, const std::string& id) {
  for (const Axis& axis : scene_axes())
    if (axis.id == id) return axis;
  for (Axis& axis : parameter_axes(techniques::resolve(technique)))
    if (axis.id == id) return axis;
  throw std::logic_error("no axis " + id);
}

struct Held {
  const char* technique;
  const char* axis;
  double value;  ///< up to which it holds
};

class EveryHeldValue : public testing::TestWithParam<Held> {};

TEST_P(EveryHeldValue, holds) {
  const auto& [technique, id, value] = GetParam();
  const Axis axis = axis_of(technique, id);
  const techniques::Resolved resolved = techniques::resolve(technique);
  const auto draw = [&](double at) { return drawing().draw(resolved, axis.trial(at), at); };
  const Step gentle = draw(axis.values.front());
  ASSERT_EQ(gentle.state, State::drawn) << gentle.message;
  EXPECT_GT(gentle.verdict.judged, 1000u);
  EXPECT_GT(gentle.verdict.shadowed, 30u);
  const Step step = draw(value);
  EXPECT_EQ(step.state, State::drawn) << step.message;
  EXPECT_FALSE(is_broken(gentle, step))
      << step.verdict.visibility_rms << " beside " << gentle.verdict.visibility_rms << ", "
      << step.verdict.dark << " of " << step.verdict.lit << " dark";
}

INSTANTIATE_TEST_SUITE_P(
    Of, EveryHeldValue,
    testing::Values(
        Held{"reference", "scale-down", 1e-8}, Held{"reference", "scale-up", 1e14},
        Held{"reference", "offset", 1e11}, Held{"reference", "offset-of-1e-4", 1e6},
        Held{"reference", "ground", 1e8}, Held{"reference", "outlier", 1e8},
        Held{"reference", "gap", 0.0}, Held{"reference", "fan", 1024},
        Held{"reference", "elevation", 0.01}, Held{"reference", "near", 1e-9},
        Held{"ray-traced", "rotation", 319.0}, Held{"ray-traced", "squash", 1e-9},
        Held{"ray-traced", "coincident", 8}, Held{"ray-traced", "blade", 1e-8},
        Held{"shadow-volumes", "zoom", 1e-3}, Held{"shadow-volumes", "ground", 1e8},
        Held{"shadow-volumes", "overlaps", 33}, Held{"shadow-volumes", "wide-view", 179.9},
        Held{"shadow-volumes", "defects", 6}, Held{"shadow-volumes", "intensity", 1e30},
        Held{"shadow-map", "ground", 1e8}, Held{"shadow-map", "near", 1e-9},
        Held{"shadow-map", "scale-down", 1e-8}, Held{"shadow-volumes", "scale-up", 1e12},
        Held{"vsm", "outlier", 1e6}, Held{"reference", "spot-distance", 1e6},
        Held{"ray-traced", "spot-distance", 1e5}, Held{"reference", "cone", 0.002},
        Held{"ray-traced", "zoom", 1e-3}, Held{"reference", "dolly", 1e-3},
        Held{"ray-traced", "orthographic-height", 1e-3}, Held{"shadow-volumes", "dolly", 1e-3},
        Held{"hybrid", "dolly", 1e-3}, Held{"reference", "light-height", 1e-6},
        Held{"shadow-volumes", "light-height", 1e-6}, Held{"pcss", "ground", 1e8},
        Held{"shadow-map", "spot-distance", 1e6}, Held{"pcss", "spot-distance", 1e6},
        Held{"esm", "spot-distance", 1e6}, Held{"esm", "point-distance", 1e6},
        Held{"pcf", "point-distance", 1e6}, Held{"msm", "scale-up", 1e14},
        Held{"shadow-map", "orthographic-outlier", 1e8},
        Held{"shadow-volumes", "orthographic-outlier", 1e8}));

TEST(WidePictures, keep_their_light_however_long_they_are) {
  // Few of their pixels see the scene: all of those are judged.
  const Axis axis = axis_of("reference", "wide-picture");
  for (const char* technique : {"reference", "ray-traced"})
    for (const double width : {1218.0, 2048.0, 8192.0}) {
      const Step step = drawing().draw(techniques::resolve(technique), axis.trial(width), width);
      EXPECT_GT(step.verdict.judged, 90u);
      EXPECT_EQ(step.verdict.visibility_rms, 0.0) << technique << ' ' << width;
      EXPECT_EQ(step.verdict.dark, 0u) << technique << ' ' << width;
    }
}

TEST(Gentle, pictures_of_exact_techniques_agree_with_the_judge_in_every_pixel) {
  const Axis axis = axis_of("reference", "rotation");
  for (const char* technique : {"reference", "ray-traced", "shadow-volumes",
                                "shadow-volumes-zpass-plus", "shadow-volumes-brute-force"}) {
    const Step step = drawing().draw(techniques::resolve(technique), axis.trial(0.0), 0.0);
    EXPECT_EQ(step.verdict.visibility_rms, 0.0) << technique;
    EXPECT_EQ(step.verdict.dark, 0u) << technique;
    EXPECT_GT(step.verdict.judged, 6000u);
  }
}

TEST(Axes, aim_zooms_at_a_border_at_every_step) {
  for (const char* id : {"zoom", "cone", "orthographic-height"}) {
    const Axis axis = axis_of("reference", id);
    for (const double value : axis.values) {
      const Trial trial = axis.trial(value);
      const Truth truth = judge(trial.scene, 32, 32, 1);
      const auto dark = std::count(truth.visible.begin(), truth.visible.end(), 0.0f);
      const auto lit = std::count(truth.visible.begin(), truth.visible.end(), 1.0f);
      EXPECT_GT(dark, 32) << id << ' ' << value;
      EXPECT_GT(lit, 32) << id << ' ' << value;
    }
  }
}

TEST(Axes, have_names_of_their_own_and_run_one_way) {
  std::vector<std::string> ids;
  for (const Axis& axis : scene_axes()) ids.push_back(axis.id);
  EXPECT_THAT(ids, testing::Not(testing::IsEmpty()));
  for (const TechniqueDescription& technique : techniques::all())
    for (const Axis& axis : parameter_axes(techniques::resolve(technique.id)))
      EXPECT_TRUE(std::is_sorted(axis.values.begin(), axis.values.end()) ||
                  std::is_sorted(axis.values.rbegin(), axis.values.rend()))
          << technique.id << ' ' << axis.id;
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
}

}  // namespace
}  // namespace penumbra::experiments::stability
