// More volumes over each other than a stencil of eight bits counts, against exact rays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/volumes/drawing.h"
#include "tests/volumes/exact_rays.h"

namespace penumbra {
namespace crowd_test {

using test::draw;
constexpr std::uint32_t width = 64;

/// Ground, a sun and a camera.
scenes::SceneBuilder stage() {
  scenes::SceneBuilder b("stack", "A stack");
  b.ground({-6.0, -6.0}, {6.0, 6.0}, b.look("grey", glm::vec3(0.7f)));
  Light sun;
  sun.name = "sun";
  sun.kind = LightKind::directional;
  sun.direction = glm::normalize(glm::dvec3(0.4, -1.0, -0.3));
  b.scene.lights.push_back(sun);
  b.camera("main", {3.5, 4.5, 7.0}, {0.3, 0.6, -0.3}, 40.0);
  return b;
}

void append(scenes::Solid& all, const scenes::Solid& part) {
  const auto first = static_cast<std::uint32_t>(all.points.size());
  all.points.insert(all.points.end(), part.points.begin(), part.points.end());
  for (const auto& t : part.triangles) all.add_triangle(first + t[0], first + t[1], first + t[2]);
}

/// Plates 2 mm thick every 4 mm, each an instance or all in one mesh.
Scene stack(int plates, bool in_one_mesh) {
  scenes::SceneBuilder b = stage();
  const scenes::Look look = b.look("red", glm::vec3(0.5f));
  scenes::Solid all;
  for (int i = 0; i < plates; ++i) {
    const double y = 0.5 + 0.004 * i;
    const scenes::Solid plate = scenes::box({-0.6, y, -0.6}, {0.6, y + 0.002, 0.6});
    if (in_one_mesh)
      append(all, plate);
    else
      b.place(plate, look, "plate " + std::to_string(i));
  }
  if (in_one_mesh) b.place(all, look, "plates");
  return b.scene;
}

/// A ramp that winds upwards, one closed body that covers itself `turns` times.
Scene screw(int turns) {
  constexpr int steps = 12;
  scenes::SceneBuilder b = stage();
  scenes::Solid ramp;
  for (int i = 0; i <= steps * turns; ++i) {
    const double angle = 6.283185307179586 * i / steps;
    const double y = 0.5 + 0.004 * i / steps;
    for (const glm::dvec2 corner : {glm::dvec2(0.3, 0.0), {0.8, 0.0}, {0.8, 0.002}, {0.3, 0.002}})
      ramp.add_point({corner.x * std::cos(angle), y + corner.y, corner.x * std::sin(angle)});
    if (i == 0) continue;
    const auto at = static_cast<std::uint32_t>(4 * i);
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t n = (k + 1) % 4;
      ramp.add_quad(at - 4 + k, at - 4 + n, at + n, at + k);
    }
  }
  const auto last = static_cast<std::uint32_t>(4 * steps * turns);
  ramp.add_quad(3, 2, 1, 0);
  ramp.add_quad(last, last + 1, last + 2, last + 3);
  b.place(ramp, b.look("red", glm::vec3(0.5f)), "ramp");
  return b.scene;
}

struct Variant {
  const char* technique;
  ParameterValues parameters = {};
  double wrong = 0.002;  ///< share of the judged pixels: some plates are thinner than a pixel
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> list = {
      {"shadow-volumes"},
      {"shadow-volumes", {{"counting", std::string("automatic")}}},
      {"shadow-volumes", {{"stencil_passes", std::int64_t{2}}}},
      {"shadow-volumes-zpass"},
      {"shadow-volumes-zpass-plus"},
      {"shadow-volumes-brute-force"},
      {"soft-shadow-volumes"},
      // Its map decides away from silhouettes.
      {"hybrid", {{"map_size", std::int64_t{64}}}, 0.02}};
  return list;
}

void expect_exact(const Scene& scene, const std::string& what) {
  const std::vector<int> truth = test::exact_visibility(scene, {}, width);
  for (const Variant& variant : variants()) {
    const RenderResult result = draw(scene, variant.technique, variant.parameters, {}, width);
    int judged = 0, dark = 0, wrong = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (truth[i] < 0 || result.judged.pixels[i] < 1.0f) continue;
      ++judged;
      dark += truth[i] == 0;
      wrong += std::abs(result.visibility.pixels[i] - static_cast<float>(truth[i])) > 0.5f;
    }
    EXPECT_GT(dark, 100) << what;
    EXPECT_LE(wrong, variant.wrong * judged) << variant.technique << " of " << what;
  }
}

TEST(Crowds, of_plates_under_a_sun_are_dark_however_many) {
  for (const int plates : {127, 128, 255, 256, 300, 512})
    for (const bool in_one_mesh : {false, true})
      expect_exact(stack(plates, in_one_mesh), std::to_string(plates) + " plates");
}

TEST(Crowds, of_turns_of_one_body_are_dark) {
  for (const int turns : {256, 300}) expect_exact(screw(turns), std::to_string(turns) + " turns");
}

TEST(Crowds, under_a_lamp_beside_them_are_dark) {
  Scene scene = stack(256, true);
  Light& lamp = scene.lights[0];
  lamp.kind = LightKind::point;
  lamp.position = {-2.0, 6.0, 1.5};
  expect_exact(scene, "plates under a lamp");
}

TEST(Crowds, of_penumbrae_are_told) {
  using testing::Contains;
  using testing::HasSubstr;
  for (const int plates : {25, 40}) {
    Scene scene = stack(plates, false);
    scene.lights[0].extent.kind = ExtentKind::disc;
    scene.lights[0].extent.radius = 1.0;
    const auto note = Contains(HasSubstr("volumes overlap"));
    const std::vector<std::string> notes = draw(scene, "soft-shadow-volumes", {}, {}, width).notes;
    if (plates > 31)
      EXPECT_THAT(notes, note);
    else
      EXPECT_THAT(notes, testing::Not(note));
  }
  Scene scene = *scenes::load("car");
  EXPECT_THAT(draw(scene, "soft-shadow-volumes", {}, {}, width).notes,
              testing::Not(Contains(HasSubstr("volumes overlap"))));
}

TEST(Crowds, are_counted_in_an_image_only_where_the_stencil_may_not_hold_them) {
  const auto counts_deeply = [](const Scene& scene, const char* technique) {
    const RenderResult result = draw(scene, technique, {}, {}, width);
    return std::any_of(result.cost.technique_memory.begin(), result.cost.technique_memory.end(),
                       [](const auto& entry) { return entry.name == "deep counts"; });
  };
  for (const char* id : {"boxes", "car", "warehouse-outside", "aircraft"})
    EXPECT_FALSE(counts_deeply(*scenes::load(id), "shadow-volumes")) << id;
  EXPECT_TRUE(counts_deeply(stack(256, false), "shadow-volumes"));
}

}  // namespace crowd_test
}  // namespace penumbra
