// What clamping leaves out, by counters, and that no picture tells.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/kept_pictures/kept_pictures.h"
#include "tests/volumes/drawing.h"
#include "tests/volumes/exact_rays.h"

namespace penumbra {
namespace {

using test::draw;

PassCost volumes_of(const RenderResult& result) {
  for (const PassCost& pass : result.cost.passes)
    if (pass.name == "volumes") return pass;
  throw std::logic_error("no volumes were drawn");
}

RenderResult clamped(const Scene& scene) {
  return draw(scene, "shadow-volumes", {{"clamp", true}});
}

int wrong_pixels(const Scene& scene, const RenderResult& result) {
  const std::vector<int> truth = test::exact_visibility(scene, {}, test::size);
  int wrong = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    wrong += result.judged.pixels[i] == 1.0f && truth[i] >= 0 &&
             result.visibility.pixels[i] != static_cast<float>(truth[i]);
  return wrong;
}

/// A crate under a plate with a hole, seen from the side and lit from above.
Scene crate_under_plate(const glm::dvec3& crate, double half_hole, LightKind kind) {
  scenes::SceneBuilder b("crate", "A crate under a plate");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-4.0, -4.0}, {4.0, 4.0}, look);
  // The plate's four sides around the hole are one instance.
  Mesh plate;
  const double h = half_hole;
  const auto part = [&](double x0, double z0, double x1, double z1) {
    scenes::add_part(plate, scenes::box({x0, 1.5, z0}, {x1, 1.55, z1}), look);
  };
  part(-1.0, -1.0, 1.0, -h);
  part(-1.0, h, 1.0, 1.0);
  part(-1.0, -h, -h, h);
  part(h, -h, 1.0, h);
  b.place(b.add_mesh("plate", std::move(plate)), glm::dmat4(1.0), "plate");
  b.place(scenes::box(crate - 0.2, crate + 0.2), look, "crate");
  b.spot("lamp", {0.3, 5.0, 0.2}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 50.0, LightExtent{})
      .kind = kind;
  b.camera("main", {0.0, 2.2, 6.0}, {0.0, 0.5, 0.0}, 45.0);
  return b.scene;
}

struct Crate {
  glm::dvec3 middle;
  double half_hole;
  bool left_out;
};

class Crates : public testing::TestWithParam<std::tuple<Crate, LightKind>> {};

TEST_P(Crates, cast_no_volume_where_they_lie_wholly_in_the_plates_shadow_and_only_there) {
  const auto& [crate, kind] = GetParam();
  Scene scene = crate_under_plate(crate.middle, crate.half_hole, kind);
  const RenderResult result = clamped(scene);
  // Sides that end at a plane may round otherwise than those that end at infinity.
  EXPECT_LE(wrong_pixels(scene, result), 2);
  const std::uint64_t with = volumes_of(result).primitives;
  for (Instance& instance : scene.instances)
    if (instance.name == "crate") instance.casts_shadow = false;
  const std::uint64_t without = volumes_of(clamped(scene)).primitives;
  EXPECT_EQ(with - without, crate.left_out ? 0u : 12u);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Crates,
    testing::Combine(testing::Values(Crate{{0.5, 0.6, 0.4}, 0.05, true},    // under the plate
                                     Crate{{1.2, 0.6, 0.4}, 0.05, false},   // under its border
                                     Crate{{2.5, 0.6, 0.4}, 0.05, false},   // beside it
                                     Crate{{0.5, 2.4, 0.4}, 0.05, false},   // above it
                                     Crate{{0.5, 1.55, 0.4}, 0.05, false},  // stuck through it
                                     Crate{{0.5, 0.6, 0.4}, 0.45, false}),  // under the hole
                     testing::Values(LightKind::spot, LightKind::point, LightKind::directional)));

TEST(Clamping, spares_the_fragments_of_what_stands_under_a_roof) {
  const Scene scene = *scenes::load("warehouse-outside");
  const RenderResult whole = draw(scene, "shadow-volumes");
  const RenderResult result = clamped(scene);
  EXPECT_TRUE(tests::same(result.visibility, whole.visibility));
  EXPECT_LT(volumes_of(result).primitives, volumes_of(whole).primitives * 4 / 5);
  EXPECT_LT(volumes_of(result).fragment_invocations,
            volumes_of(whole).fragment_invocations * 7 / 10);
}

/// A low sun throws the shadow of a box over the ground's border, and there the camera stands.
Scene camera_behind_all_surfaces() {
  scenes::SceneBuilder b("behind", "A camera in the shadow behind everything");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-3.0, -2.0}, {1.0, 2.0}, look);
  b.place(scenes::box({-1.2, 0.3, -0.6}, {-0.8, 1.3, 0.6}), look, "box");
  b.spot("sun", {-10.0, 1.5, 0.0}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 50.0, LightExtent{})
      .kind = LightKind::directional;
  b.camera("main", {4.0, 0.35, 0.1}, {-0.5, 0.1, 0.0}, 40.0);
  return b.scene;
}

/// A narrow lamp, and between it and the camera a box that its cone misses.
Scene camera_behind_a_box_outside_the_cone() {
  scenes::SceneBuilder b("beside", "A camera behind a box that the cone misses");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-3.0, -3.0}, {3.0, 3.0}, look);
  b.place(scenes::box({-0.2, 0.4, -0.2}, {0.2, 0.8, 0.2}), look, "lit box");
  b.place(scenes::box({1.4, 2.2, -0.5}, {1.6, 2.8, 0.5}), look, "box outside");
  b.spot("lamp", {0.0, 4.0, 0.0}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 18.0, LightExtent{});
  b.camera("main", {2.3, 1.55, 0.0}, {0.0, 0.2, 0.0}, 40.0);
  return b.scene;
}

TEST(Clamping, keeps_the_count_of_a_near_plane_in_shadow) {
  for (const Scene& scene :
       {camera_behind_all_surfaces(), camera_behind_a_box_outside_the_cone()}) {
    for (const char* technique : {"shadow-volumes-zpass-plus", "shadow-volumes"})
      EXPECT_LE(wrong_pixels(scene, draw(scene, technique, {{"clamp", true}})), 2)
          << scene.id << ' ' << technique;
    EXPECT_GT(wrong_pixels(scene, draw(scene, "shadow-volumes-zpass")), 500)
        << scene.id << ": the near plane is in shadow";
  }
}

TEST(Clamping, keeps_caps_on_the_near_plane_and_sides_in_step) {
  const Scene scene = *scenes::load("camera-in-volume");
  EXPECT_LE(wrong_pixels(scene, draw(scene, "shadow-volumes-zpass-plus", {{"clamp", true}})), 5);
}

}  // namespace
}  // namespace penumbra
