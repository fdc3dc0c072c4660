// Layouts: which views a light's map has. Judged by rays that Embree follows, for every technique
// that has a map and every layout there is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "avenue.h"
#include "drawing.h"
#include "hard_truth.h"
#include "renderer/error.h"
#include "renderer/metrics/metrics.h"
#include "scenes.h"
#include "techniques/layout_matrix.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace layouts_test {

constexpr std::uint32_t picture = 128;  // pixels a side

/// All techniques with a map, plain settings.
std::vector<std::string> map_techniques() {
  std::vector<std::string> ids;
  for (const auto& row : techniques::layout_matrix()) ids.push_back(row.technique);
  return ids;
}

metrics::VisibilityError error_of(const Scene& scene, const ImageF& truth,
                                  const std::string& technique, const ParameterValues& parameters) {
  const RenderResult result = draw(scene, technique, parameters, picture);
  EXPECT_EQ(result.non_finite_pixels, 0u);
  return tests::visibility_error(result.visibility, truth, result.judged);
}

TEST(Layouts, every_filter_on_every_layout_is_near_the_truth) {
  const Scene scene = avenue();
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  const double unshadowed = error_of(scene, truth, "none", {}).rms;
  ASSERT_GT(unshadowed, 0.2);
  for (const std::string& technique : map_techniques())
    for (const std::string& layout : layout_ids()) {
      if (!draws_sun(technique, layout)) continue;
      SCOPED_TRACE(technique + " on " + layout);
      EXPECT_LT(error_of(scene, truth, technique, {{"layout", layout}, {"map_size", 1024}}).rms,
                0.5 * unshadowed);
    }
}

TEST(Layouts, cascades_are_nearer_the_truth_than_one_view_of_the_same_bytes) {
  const Scene scene = avenue();
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  for (const char* technique : {"shadow-map", "pcf-bilinear-3x3", "vsm"}) {
    SCOPED_TRACE(technique);
    const double single = error_of(scene, truth, technique, {{"map_size", 512}}).rms;
    const double cascaded =
        error_of(scene, truth, technique, {{"map_size", 256}, {"layout", "cascaded"}}).rms;
    EXPECT_LT(cascaded, 0.85 * single);
  }
}

TEST(Layouts, warps_are_nearer_the_truth_than_one_view_of_the_same_bytes) {
  const Scene scene = avenue();
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  const auto error = [&](const std::string& layout, const std::string& focus) {
    return error_of(scene, truth, "pcf-bilinear-3x3",
                    {{"map_size", 256}, {"layout", layout}, {"focus", focus}})
        .rms;
  };
  const double plain = error("single", "scene");
  const double focused = error("single", "seen");
  EXPECT_LT(focused, plain);
  EXPECT_LT(error("light-space-perspective", "scene"), 0.8 * focused);
  EXPECT_LT(error("trapezoidal", "scene"), 0.8 * focused);
}

TEST(Layouts, cameras_and_lights_may_turn_all_the_way) {
  Scene scene = avenue();
  for (int step = 0; step < 12; ++step) {
    const double angle = step * 0.52359878;
    Camera& camera = scene.cameras[0];
    camera.target =
        camera.position + glm::dvec3(20.0 * std::sin(angle), -2.0, 20.0 * std::cos(angle));
    // Up to a light that stands low behind the ground's edge, and one along the view.
    scene.lights[0].direction =
        glm::normalize(glm::dvec3(std::cos(2.0 * angle), -0.2 - 0.1 * step, std::sin(2.0 * angle)));
    if (step == 11) scene.lights[0].direction = glm::normalize(camera.target - camera.position);
    const ImageF truth = HardTruth(scene).visibility("", picture, picture);
    for (const std::string& layout : layout_ids()) {
      SCOPED_TRACE(layout + " at step " + std::to_string(step));
      const auto error =
          error_of(scene, truth, "shadow-map", {{"layout", layout}, {"map_size", 1024}});
      EXPECT_LT(error.false_shadow, 0.06);
      EXPECT_LT(error.missing_shadow, 0.06);
    }
  }
}

TEST(Layouts, none_loses_a_caster_behind_the_camera) {
  // It stands over the camera's head and shadows the ground before its feet.
  Scene scene = plain();
  add_box(scene, {-1.5, 9, 8}, {1.5, 11, 10});
  scene.lights.push_back(slanted_sun({0, -1, -1}));
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  const auto is_inside = [&](std::uint32_t x, std::uint32_t y) {
    constexpr std::uint32_t reach = 6;
    if (x < reach || y < reach || x + reach >= picture || y + reach >= picture) return false;
    for (std::uint32_t v = y - reach; v <= y + reach; ++v)
      for (std::uint32_t u = x - reach; u <= x + reach; ++u)
        if (truth.at(u, v, 0) > 0.5f) return false;
    return true;
  };
  for (const std::string& layout : layout_ids()) {
    SCOPED_TRACE(layout);
    const RenderResult result = draw(scene, "shadow-map", {{"layout", layout}}, picture);
    std::size_t inside = 0;
    for (std::uint32_t y = 0; y < picture; ++y)
      for (std::uint32_t x = 0; x < picture; ++x) {
        if (!is_inside(x, y)) continue;
        ++inside;
        EXPECT_EQ(result.visibility.at(x, y, 0), 0.0f) << x << ", " << y;
      }
    EXPECT_GT(inside, 100u);
  }
}

TEST(Layouts, open_ground_is_lit_across_all_borders) {
  Scene scene = plain();
  scene.lights.push_back(slanted_sun({0.7, -1.0, -0.3}));
  for (const std::string& technique : map_techniques()) {
    // Bounds of moments and exponentials are not sharp where a texel spans metres of depth. Their
    // filters know how the receiver's plane scatters there, but for what interpolation adds.
    const bool compares = techniques::resolve(technique).parameters.contains("depth");
    for (const std::string& layout : layout_ids()) {
      if (!draws_sun(technique, layout)) continue;
      SCOPED_TRACE(technique + " on " + layout);
      const RenderResult result = draw(scene, technique, {{"layout", layout}}, picture);
      float darkest = 1.0f;
      double sum = 0.0;
      double judged = 0.0;
      for (std::size_t i = 0; i < result.visibility.pixels.size(); ++i) {
        if (result.judged.pixels[i] < 0.5f) continue;
        darkest = std::min(darkest, result.visibility.pixels[i]);
        sum += static_cast<double>(result.visibility.pixels[i]);
        judged += 1.0;
      }
      EXPECT_GT(judged, 4000.0);
      EXPECT_GT(sum / judged, compares ? 0.9999 : 0.9995);
      EXPECT_GT(darkest, compares ? 0.9999f : 0.97f);
    }
  }
}

TEST(Layouts, memory_is_that_of_the_views) {
  const Scene scene = avenue();
  const RenderResult result = draw(
      scene, "shadow-map", {{"layout", "cascaded"}, {"cascades", 3}, {"map_size", 1024}}, picture);
  ASSERT_EQ(result.cost.technique_memory.size(), 1u);
  EXPECT_EQ(result.cost.technique_memory[0].bytes, 12582912u);
}

TEST(Layouts, refuse_lights_as_the_matrix_says) {
  for (const auto& [kind, name] : {std::pair{LightKind::spot, "spot"},
                                   {LightKind::point, "point"},
                                   {LightKind::directional, "directional"}}) {
    Scene scene = plain();
    scene.lights.push_back(lamp({0, 5, 0}, 40));
    scene.lights[0].kind = kind;
    for (const auto& row : techniques::layout_matrix())
      for (const auto& [layout, lights] : row.lights) {
        const bool serves = testing::Value(lights, testing::Contains(name));
        SCOPED_TRACE(row.technique + " on " + layout);
        try {
          draw(scene, row.technique, {{"layout", layout}}, 16);
          EXPECT_TRUE(serves);
        } catch (const Error& error) {
          EXPECT_FALSE(serves) << error.what();
          EXPECT_EQ(error.code, "unsupported");
          EXPECT_EQ(error.field, "layout");
          EXPECT_THAT(error.what(), testing::HasSubstr(layout));
        }
      }
  }
}

/// Share of the surface points that both cameras see whose visibility differs. The second camera
/// stands 8 of 64 pixels to the right.
double changed_share(const Scene& scene, const ParameterValues& parameters) {
  RenderRequest from_first =
      request(std::make_shared<const Scene>(scene), "shadow-map", parameters);
  const RenderResult first = renderer().render(from_first);
  from_first.camera = "moved";
  const RenderResult second = renderer().render(from_first);
  std::size_t compared = 0;
  std::size_t changed = 0;
  for (std::uint32_t y = 0; y < 64; ++y)
    for (std::uint32_t x = 8; x < 64; ++x) {
      if (first.judged.at(x, y, 0) < 0.5f || second.judged.at(x - 8, y, 0) < 0.5f) continue;
      ++compared;
      changed += std::abs(first.visibility.at(x, y, 0) - second.visibility.at(x - 8, y, 0)) > 0.01f;
    }
  EXPECT_GT(compared, 2000u);
  return static_cast<double>(changed) / static_cast<double>(compared);
}

TEST(Layouts, a_penumbra_is_as_wide_on_every_layout) {
  // A plate 4 m over the ground whose edge runs along the view, under a sun of 3 degrees overhead:
  // the penumbra is linear and 2 x 4 m x tan(3 degrees) wide.
  Scene scene = plain();
  add_plate(scene, {-30, -60}, {0, 8}, 4.0);
  Light light = sun();
  light.extent = {.kind = ExtentKind::disc, .radius = 3.0};
  scene.lights.push_back(light);
  Camera& camera = scene.cameras[0];
  camera.position = {0, 2, 2};
  camera.target = {0, 0, -6};
  const double half_width = 4.0 * std::tan(glm::radians(3.0));
  for (const std::string& layout : layout_ids()) {
    SCOPED_TRACE(layout);
    const RenderResult result =
        draw(scene, "pcss", {{"layout", layout}, {"map_size", 1024}, {"taps", 256}}, picture);
    // Over a disc visibility is 1/2 + (x sqrt(1 - x^2) + asin x) / pi at x half widths.
    double sum = 0.0;
    std::size_t judged = 0;
    const double tangent = std::tan(glm::radians(0.5 * camera.vertical_fov));
    const glm::dvec3 ahead = glm::normalize(camera.target - camera.position);
    const glm::dvec3 up = glm::normalize(glm::cross(glm::cross(ahead, {0, 1, 0}), ahead));
    for (std::uint32_t y = 0; y < picture; ++y)
      for (std::uint32_t x = 0; x < picture; ++x) {
        const double right = tangent * (2.0 * (x + 0.5) / picture - 1.0);
        const double rise = tangent * (1.0 - 2.0 * (y + 0.5) / picture);
        const glm::dvec3 ray = ahead + glm::dvec3(right, 0, 0) + rise * up;
        if (ray.y > -0.1) continue;
        const glm::dvec3 place = camera.position - ray * (camera.position.y / ray.y);
        const double across = place.x / half_width;
        if (std::abs(across) > 0.9 || place.z < -20.0) continue;
        const double lit = 0.5 + (across * std::sqrt(1.0 - across * across) + std::asin(across)) /
                                     3.14159265358979;
        sum += std::abs(static_cast<double>(result.visibility.at(x, y, 0)) - lit);
        ++judged;
      }
    EXPECT_GT(judged, 500u);
    // A penumbra wider by a twentieth is off by 0.016 on average; noise of the taps is larger.
    EXPECT_LT(sum / static_cast<double>(judged), 0.05);
  }
}

TEST(Layouts, snapped_cascades_do_not_crawl_when_the_camera_moves) {
  Scene scene = empty_scene(4.0, 6.0);
  add_plate(scene, {-20, -20}, {20, 20}, 0.0);
  for (int i = -8; i < 8; ++i) {
    const glm::dvec3 at(0.61 * i, 0.001, 0.37 * (i % 5));
    add_box(scene, at, at + glm::dvec3(0.11, 0.9, 0.17));
  }
  scene.lights.push_back(slanted_sun({0.6, -1.0, 0.35}));
  Camera moved = scene.cameras[0];
  moved.name = "moved";
  moved.position.x += 0.75;  // 8 of 64 pixels of 6 m
  moved.target.x += 0.75;
  scene.cameras.push_back(moved);
  const auto values = [](bool snapping) {
    return ParameterValues{
        {"layout", "cascaded"}, {"map_size", 64}, {"cascade_snapping", snapping}};
  };
  const double snapped = changed_share(scene, values(true));
  const double tight = changed_share(scene, values(false));
  EXPECT_LT(snapped, 0.001);
  EXPECT_GT(tight, 0.005);
}

TEST(Layouts, pictures_drawn_in_windows_are_fitted_to_the_whole) {
  RendererOptions small{.device = "", .validation = true};
  small.most_window_samples = 2048;
  Renderer in_windows(small);
  const auto scene = std::make_shared<const Scene>(avenue());
  for (const std::string& layout : layout_ids()) {
    SCOPED_TRACE(layout);
    const RenderRequest whole = request(scene, "pcf-bilinear-3x3", {{"layout", layout}}, picture);
    const ImageF in_parts = in_windows.render(whole).visibility;
    const ImageF at_once = renderer().render(whole).visibility;
    std::size_t different = 0;
    for (std::size_t i = 0; i < at_once.pixels.size(); ++i)
      different += std::abs(in_parts.pixels[i] - at_once.pixels[i]) > 0.01f;
    // A place is rounded otherwise in another window.
    EXPECT_LE(different, at_once.pixels.size() / 500);
  }
}

}  // namespace layouts_test
}  // namespace penumbra::tests
