// Perspective shadow maps: the layout whose texels are those of the camera's own picture. Judged by
// rays that Embree follows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "avenue.h"
#include "drawing.h"
#include "hard_truth.h"
#include "renderer/scene/convex_clip.h"
#include "scenes.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace perspective_test {

constexpr std::uint32_t picture = 128;  // pixels a side

Scene ground() {
  return plain({0, 2, 5}, {0, 0, -6}, 40.0);
}

void add_posts(Scene& scene) {
  for (const double z : {1.0, -1.0, -4.0, -8.0, -14.0, -22.0})
    for (const double x : {-2.5, 0.0, 2.0})
      add_box(scene, {x - 0.3, 0.001, z - 0.3}, {x + 0.3, 1.5, z + 0.3});
}

Light lamp_towards(const glm::dvec3& position, const glm::dvec3& target, double half_angle) {
  Light light = lamp(position, half_angle);
  light.direction = glm::normalize(target - position);
  return light;
}

metrics::VisibilityError error_of(const Scene& scene, const ParameterValues& parameters) {
  const RenderResult result = draw(scene, "shadow-map", parameters, picture);
  EXPECT_EQ(result.non_finite_pixels, 0u);
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  return visibility_error(result.visibility, truth, result.judged);
}

double rms_of(const Scene& scene, const ParameterValues& parameters) {
  return error_of(scene, parameters).rms;
}

/// Of a picture without shadows.
double unshadowed_error(const Scene& scene) {
  const RenderResult result = draw(scene, "none", {}, picture);
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  return visibility_error(result.visibility, truth, result.judged).rms;
}

/// Root mean square of errors between two rows of the picture.
double error_of_rows(const RenderResult& result, const ImageF& truth, std::uint32_t first,
                     std::uint32_t end) {
  double sum = 0.0, judged = 0.0;
  for (std::uint32_t y = first; y < end; ++y)
    for (std::uint32_t x = 0; x < picture; ++x) {
      if (result.judged.at(x, y, 0) < 0.5f) continue;
      const double off = static_cast<double>(result.visibility.at(x, y, 0) - truth.at(x, y, 0));
      sum += off * off;
      judged += 1.0;
    }
  EXPECT_GT(judged, 500.0);
  return std::sqrt(sum / judged);
}

TEST(PerspectiveMaps, fit_to_the_corners_of_what_half_spaces_enclose) {
  // The unit cube without the corner x + y + z > 2.5: seven corners of its own and three on edges.
  std::vector<HalfSpace> sides{{1, 0, 0, 0},  {0, 1, 0, 0},  {0, 0, 1, 0},     {-1, 0, 0, 1},
                               {0, -1, 0, 1}, {0, 0, -1, 1}, {-2, -2, -2, 5.0}};
  std::vector<glm::dvec3> corners = body_corners(sides);
  EXPECT_EQ(corners.size(), 10u);
  for (const glm::dvec3& wanted :
       {glm::dvec3(0, 0, 0), glm::dvec3(1, 1, 0), glm::dvec3(0.5, 1, 1), glm::dvec3(1, 1, 0.5)})
    EXPECT_TRUE(
        std::any_of(corners.begin(), corners.end(),
                    [&](const glm::dvec3& corner) { return glm::length(corner - wanted) < 1e-9; }))
        << wanted.x << ", " << wanted.y << ", " << wanted.z;
  // Nothing lies within two that exclude each other.
  sides.push_back({1, 0, 0, -2});
  EXPECT_TRUE(body_corners(sides).empty());
}

TEST(PerspectiveMaps, win_near_the_camera_over_one_plain_view_of_the_scene) {
  Scene scene = ground();
  add_posts(scene);
  scene.lights.push_back(slanted_sun({0.7, -1.0, -0.3}));
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  const auto near_error = [&](const ParameterValues& parameters) {
    const RenderResult result = draw(scene, "shadow-map", parameters, picture);
    return error_of_rows(result, truth, picture / 2, picture);
  };
  const double plain = near_error({{"map_size", 256}});
  const double focused = near_error({{"map_size", 256}, {"focus", "seen"}});
  const double warped = near_error({{"map_size", 256}, {"layout", "perspective"}});
  EXPECT_LT(warped, 0.5 * plain);
  EXPECT_LT(warped, 0.8 * focused);
}

TEST(PerspectiveMaps, without_a_virtual_camera_lose_casters_behind_the_camera) {
  // A roof behind the viewer whose shadow falls before him: a sun from behind.
  Scene scene = ground();
  add_box(scene, {-2, 8, 8}, {2, 8.5, 11});
  scene.lights.push_back(slanted_sun({0, -1, -1.2}));
  const auto kept = error_of(scene, {{"layout", "perspective"}});
  const auto lost = error_of(scene, {{"layout", "perspective"}, {"virtual_camera", false}});
  const double none = unshadowed_error(scene);
  EXPECT_LT(kept.rms, 0.25 * none);
  // All of the roof's shadow is gone.
  EXPECT_NEAR(lost.rms, none, 1e-3);
  EXPECT_GT(none, 0.15);
}

TEST(PerspectiveMaps, gain_by_cube_clipping) {
  Scene scene = ground();
  add_posts(scene);
  // A lamp that lights a patch, and a sun over all of the ground.
  for (const Light& light :
       {lamp_towards({1.2, 4, 0}, {0, 0, -2}, 35), slanted_sun({0.7, -1.0, -0.3})}) {
    scene.lights = {light};
    const auto error = [&](bool clipped) {
      return rms_of(scene,
                    {{"layout", "perspective"}, {"map_size", 128}, {"cube_clipping", clipped}});
    };
    EXPECT_LT(error(true), 0.9 * error(false)) << light.name;
  }
}

TEST(PerspectiveMaps, stay_finite_and_true_wherever_camera_and_light_stand) {
  Scene scene = ground();
  add_posts(scene);
  const glm::dvec3 target{0, 0, -4};
  Camera& camera = scene.cameras[0];
  for (int step = 0; step < 12; ++step) {
    const double angle = step * 0.52359878;
    camera.target = camera.position + glm::dvec3(11 * std::sin(angle), -2, -11 * std::cos(angle));
    for (const bool is_lamp : {false, true}) {
      SCOPED_TRACE((is_lamp ? "lamp" : "sun") + std::string(" at step ") + std::to_string(step));
      // Lights before, beside and behind the viewer, in the picture too.
      const glm::dvec3 from(7 * std::cos(1.7 * angle), 3 + 0.3 * step, 7 * std::sin(1.7 * angle));
      scene.lights = {is_lamp ? lamp_towards(target + from, target, 30 + 3 * step)
                              : slanted_sun(-from)};
      const ParameterValues own{{"layout", "perspective"}, {"map_size", 1024}};
      const auto error = error_of(scene, own);
      EXPECT_LT(error.false_shadow, 0.06);
      EXPECT_LT(error.missing_shadow, 0.06);
      // All that the camera could see may be far more than the map can serve, with a lamp in the
      // picture above all: bad, but a picture. error_of asks for finite ones.
      ParameterValues unclipped = own;
      unclipped["cube_clipping"] = false;
      const auto worse = error_of(scene, unclipped);
      EXPECT_LT(worse.false_shadow, 0.2);
      EXPECT_LT(worse.missing_shadow, 0.2);
    }
  }
}

/// Per cent of the map that the notes say is used.
int used_texels(const Scene& scene, const ParameterValues& parameters) {
  const std::string words = "what is seen covers ";
  for (const std::string& note : draw(scene, "shadow-map", parameters, 16).notes)
    if (const auto at = note.find(words); at != std::string::npos)
      return std::stoi(note.substr(at + words.size()));
  ADD_FAILURE() << "no note tells it";
  return -1;
}

TEST(PerspectiveMaps, tell_how_many_texels_they_waste) {
  // From straight above a square of ground is seen, which fills the map but for a guard of a texel
  // on each side. A camera 2 m up that looks 21.80 degrees down sees of ground that ends 20 m ahead
  // a trapezoid from 1.88 m on, 2.32 m wide at first and 18.01 m at last.
  Scene scene = empty_scene(2.0, 4.0);
  add_plate(scene, {-10, -10}, {10, 10}, 0.0);
  scene.lights.push_back(sun());
  const int square = used_texels(scene, {{"focus", "seen"}, {"map_size", 512}});
  EXPECT_NEAR(square, 100.0 * 510.0 * 510.0 / (512.0 * 512.0), 1.0);
  Scene along = empty_scene(2.0, 4.0);
  add_plate(along, {-40, -15}, {40, 40}, 0.0);
  along.cameras = ground().cameras;
  along.cameras[0].target = {0, 0, 0};
  along.lights.push_back(sun());
  const int plain = used_texels(along, {{"focus", "seen"}, {"map_size", 512}});
  const int bent = used_texels(along, {{"layout", "perspective"}, {"map_size", 512}});
  const double guard = 510.0 * 510.0 / (512.0 * 512.0);
  EXPECT_NEAR(plain, 100.0 * guard * 0.5 * (2.32 + 18.01) / 18.01, 1.0);
  EXPECT_GT(bent, plain + 15);
}

TEST(PerspectiveMaps, of_an_orthographic_camera_or_a_parallel_light_are_plain) {
  // Nothing is bent: as good as the focused view, of a sun right along the view.
  Scene scene = ground();
  add_posts(scene);
  Camera& camera = scene.cameras[0];
  camera.projection = Projection::orthographic;
  camera.orthographic_height = 12.0;
  scene.lights.push_back(slanted_sun({0.7, -1.0, -0.3}));
  const double focused = rms_of(scene, {{"map_size", 256}, {"focus", "seen"}});
  EXPECT_NEAR(rms_of(scene, {{"map_size", 256}, {"layout", "perspective"}}), focused,
              0.25 * focused);
}

TEST(PerspectiveMaps, of_a_lamp_wider_than_one_view_are_six_plain_ones) {
  Scene scene = ground();
  add_posts(scene);
  scene.lights.push_back(lamp_towards({0.4, 6, -3}, {0, 0, -3}, 80));
  const RenderResult wide =
      draw(scene, "shadow-map", {{"layout", "perspective"}, {"map_size", 64}}, picture);
  ASSERT_EQ(wide.cost.technique_memory.size(), 1u);
  EXPECT_EQ(wide.cost.technique_memory[0].bytes, 6u * 64u * 64u * 4u);
  EXPECT_LT(rms_of(scene, {{"layout", "perspective"}, {"map_size", 512}}), 0.1);
}

}  // namespace perspective_test
}  // namespace penumbra::tests
