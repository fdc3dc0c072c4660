// Penumbra wedges against closed forms and against many exact rays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/shadow_volumes/coverage_table.h"
#include "tests/kept_pictures/kept_pictures.h"
#include "tests/volumes/drawing.h"

namespace penumbra {
namespace soft_volumes_test {

using shadow_volumes::part_beyond_line;
using test::draw;
using test::ground_point;
using test::size;

constexpr double pi = 3.14159265358979323846;

/// What lies beyond a whole line.
double beyond(LightShape shape, double direction, double distance) {
  return part_beyond_line(shape, direction, distance, 0.5 * pi) -
         part_beyond_line(shape, direction, distance, -0.5 * pi);
}

TEST(CoverageTable, knows_the_part_of_a_disc_a_ball_and_a_square_beyond_a_line) {
  for (const double d : {0.0, 0.1, 0.35, 0.7, 0.95}) {
    EXPECT_NEAR(beyond(LightShape::disc, 0.3, d), (std::acos(d) - d * std::sqrt(1.0 - d * d)) / pi,
                1e-9);
    EXPECT_NEAR(beyond(LightShape::ball, 0.3, d), (1.0 - d) * (1.0 - d) * (2.0 + d) / 4.0, 2e-5);
    EXPECT_NEAR(beyond(LightShape::square, 0.0, d), (1.0 - d) / 2.0, 2e-4);
    // Across the diagonal, beyond sqrt(2) / 2 * 2 = sqrt(2) nothing is left; the rest is a
    // triangle.
    const double rest = std::sqrt(2.0) - d;
    EXPECT_NEAR(beyond(LightShape::square, 0.25 * pi, d), rest * rest / 4.0, 2e-4);
  }
}

TEST(CoverageTable, holds_those_parts_at_its_places) {
  for (const LightShape shape : {LightShape::disc, LightShape::ball, LightShape::square}) {
    const auto table = shadow_volumes::make_coverage_table(shape, 32);
    for (const std::uint32_t k : {0u, table.directions / 2})
      for (const std::uint32_t i : {0u, 5u, 20u, 31u})
        for (const std::uint32_t j : {0u, 11u, 16u, 31u})
          EXPECT_NEAR(static_cast<double>(table.values[(k * 32 + i) * 32 + j]),
                      part_beyond_line(
                          shape, table.directions > 1 ? 0.5 * pi * k / (table.directions - 1) : 0.0,
                          static_cast<double>(table.range) * i / 31.0, -0.5 * pi + pi * j / 31.0),
                      3e-4);
  }
}

TEST(CoverageTable, spreads_its_points_as_the_light_is_spread) {
  for (const LightShape shape : {LightShape::disc, LightShape::ball, LightShape::square})
    for (const double direction : {0.0, 0.4, 2.0, 4.5}) {
      int count = 0;
      for (const glm::dvec2& p : shadow_volumes::light_lattice(shape, 4096))
        count += p.x * std::cos(direction) + p.y * std::sin(direction) > 0.4;
      EXPECT_NEAR(count / 4096.0, beyond(shape, direction, 0.4), 0.01);
    }
}

/// Share of the light that the edge of the scene half-plane leaves visible on the ground at x.
double visible_beside_edge(double x) {
  return std::clamp(0.5 + 3.0 * x, 0.0, 1.0);
}

TEST(SoftShadowVolumes, of_a_straight_edge_are_linear_across_the_penumbra) {
  const Scene scene = *scenes::load("half-plane");
  const RenderResult result = draw(scene, "soft-shadow-volumes");
  double worst = 0.0;
  int inside = 0;
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const double truth = visible_beside_edge(ground_point(scene.cameras[0], x, y).x);
      inside += truth > 0.0 && truth < 1.0;
      worst = std::max(worst, std::abs(static_cast<double>(result.visibility.at(x, y, 0)) - truth));
    }
  EXPECT_GT(inside, 5000);
  EXPECT_LT(worst, 0.006) << "the plate is 1 mm thick, and the table has 64 places";
}

/// Two plates, one just above the other, whose edges lie above each other.
TEST(SoftShadowVolumes, count_once_what_two_casters_hide_unless_told_to_add) {
  Scene scene = *scenes::load("half-plane");
  Instance upper = scene.instances[1];
  ASSERT_EQ(upper.name, "edge");
  upper.world_from_object = glm::translate(glm::dmat4(1.0), {0.0, 0.002, 0.0});
  scene.instances.push_back(upper);
  const RenderResult counted = draw(scene, "soft-shadow-volumes");
  const RenderResult added = draw(scene, "soft-shadow-volumes-2007");
  for (std::uint32_t x = 0; x < size; ++x) {
    const double truth = visible_beside_edge(ground_point(scene.cameras[0], x, size / 2).x);
    EXPECT_NEAR(static_cast<double>(counted.visibility.at(x, size / 2, 0)), truth, 0.05);
    EXPECT_NEAR(static_cast<double>(added.visibility.at(x, size / 2, 0)),
                std::max(0.0, 2.0 * truth - 1.0), 0.02);
  }
}

/// A box that floats over the ground, under a light of this kind and extent.
Scene floating_box(LightKind kind, const LightExtent& extent) {
  scenes::SceneBuilder b("floating-box", "A box over the ground");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-3.0, -3.0}, {3.0, 3.0}, look);
  b.place(scenes::box({-0.4, 0.5, -0.3}, {0.5, 0.9, 0.4}), look, "box");
  b.spot("lamp", {1.1, 3.0, 0.7}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 60.0, extent).kind = kind;
  b.camera("main", {2.0, 2.6, 3.4}, {-0.2, 0.2, -0.1}, 50.0);
  return b.scene;
}

RenderResult reference(const Scene& scene, std::uint32_t samples, std::uint32_t width = size) {
  const auto resolved = techniques::resolve("reference");
  RenderRequest request;
  request.scene = std::make_shared<const Scene>(scene);
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.width = request.height = width;
  request.visibility = true;
  request.light_samples = samples;
  return test::renderer().render(request);
}

double visibility_rms(const RenderResult& result, const RenderResult& truth) {
  return tests::visibility_error(result.visibility, truth.visibility, truth.judged).rms;
}

struct Case {
  LightKind kind;
  LightExtent extent;
};

class Extents : public testing::TestWithParam<Case> {};

TEST_P(Extents, throw_the_penumbrae_of_many_rays) {
  const Scene scene = floating_box(GetParam().kind, GetParam().extent);
  const RenderResult truth = reference(scene, 1024);
  const RenderResult soft = draw(scene, "soft-shadow-volumes");
  const RenderResult hard = draw(scene, "shadow-volumes");
  EXPECT_LT(visibility_rms(soft, truth), 0.008);
  EXPECT_LT(visibility_rms(soft, truth), visibility_rms(hard, truth) / 6.0);
}

TEST_P(Extents, throw_them_for_a_parallel_view_too_and_clamped_just_the_same) {
  Scene scene = floating_box(GetParam().kind, GetParam().extent);
  scene.cameras[0].projection = Projection::orthographic;
  scene.cameras[0].orthographic_height = 4.0;
  const RenderResult truth = reference(scene, 256);
  const RenderResult whole = draw(scene, "soft-shadow-volumes");
  EXPECT_LT(visibility_rms(whole, truth), 0.012);
  const RenderResult clamped = draw(scene, "soft-shadow-volumes", {{"clamp", true}});
  EXPECT_LT(visibility_rms(clamped, whole), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Extents,
    testing::Values(Case{LightKind::spot, scenes::disc(0.25)},
                    Case{LightKind::point, scenes::ball(0.3)},
                    Case{LightKind::spot, scenes::rectangle(0.7, 0.3)},
                    Case{LightKind::directional, LightExtent{ExtentKind::disc, 4.0, {}}},
                    Case{LightKind::directional, LightExtent{ExtentKind::rectangle, 0.0, {9, 5}}}));

TEST(SoftShadowVolumes, stay_right_where_the_camera_is_in_wedges_and_volumes) {
  const Scene scene = *scenes::load("camera-in-volume");
  EXPECT_LT(visibility_rms(draw(scene, "soft-shadow-volumes"), reference(scene, 256)), 0.01);
}

TEST(SoftShadowVolumes, are_nearer_the_truth_on_disco_box_than_any_map) {
  const Scene scene = *scenes::load("disco-box");
  constexpr std::uint32_t width = 100;
  const RenderResult truth = reference(scene, 256, width);
  const auto error = [&](const std::string& technique) {
    return visibility_rms(draw(scene, technique, {}, {}, width), truth);
  };
  const double own = error("soft-shadow-volumes");
  EXPECT_LT(own, 0.015);
  int maps = 0;
  for (const TechniqueDescription& technique : techniques::all()) {
    if (technique.family != "map") continue;
    ++maps;
    EXPECT_LT(own, error(technique.id)) << technique.id;
  }
  EXPECT_GE(maps, 4);
}

const PassCost* find_pass(const RenderResult& result, const std::string& name) {
  for (const PassCost& pass : result.cost.passes)
    if (pass.name == name) return &pass;
  return nullptr;
}

TEST(SoftShadowVolumes, of_a_light_without_extent_are_the_hard_ones_at_their_price) {
  const Scene scene = floating_box(LightKind::spot, LightExtent{});
  const RenderResult soft = draw(scene, "soft-shadow-volumes");
  const RenderResult hard = draw(scene, "shadow-volumes");
  EXPECT_TRUE(tests::same(soft.visibility, hard.visibility));
  EXPECT_EQ(find_pass(soft, "wedges"), nullptr);
  ASSERT_NE(find_pass(soft, "volumes"), nullptr);
  EXPECT_EQ(find_pass(soft, "volumes")->fragment_invocations,
            find_pass(hard, "volumes")->fragment_invocations);
  EXPECT_EQ(soft.cost.technique_memory.size(), hard.cost.technique_memory.size());
}

TEST(SoftShadowVolumes, as_published_take_eight_bytes_a_pixel_beside_adjacency_and_table) {
  const Scene scene = floating_box(LightKind::spot, scenes::disc(0.2));
  std::uint64_t bytes = 0;
  for (const ResourceCost& resource : draw(scene, "soft-shadow-volumes-2007").cost.technique_memory)
    if (resource.name != "adjacency" && resource.name != "coverage table") bytes += resource.bytes;
  EXPECT_EQ(bytes, std::uint64_t{size} * size * 8);
}

/// Silhouette edges of the box at this place, from the signs of its faces: an edge between two of
/// the twelve pairs of neighbouring faces of which one is lit.
int silhouette_edges(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& light) {
  const auto lit = [&](int face) {
    const int axis = face / 2;
    return face % 2 == 0 ? light[axis] < low[axis] : light[axis] > high[axis];
  };
  int count = 0;
  for (int a = 0; a < 6; ++a)
    for (int b = a + 1; b < 6; ++b) count += a / 2 != b / 2 && lit(a) != lit(b);
  return count;
}

TEST(SoftShadowVolumes,
     draw_six_polygons_for_an_edge_hard_ones_two_brute_force_six_a_lit_triangle) {
  Scene scene = floating_box(LightKind::spot, scenes::disc(0.05));
  scene.instances[0].casts_shadow = false;  // the ground
  const int edges = silhouette_edges({-0.4, 0.5, -0.3}, {0.5, 0.9, 0.4}, {1.1, 3.0, 0.7});
  ASSERT_EQ(edges, 6) << "the light is seen from three faces";
  const auto primitives = [&](const char* technique, const char* pass) {
    return find_pass(draw(scene, technique), pass)->geometry_primitives;
  };
  EXPECT_EQ(primitives("soft-shadow-volumes", "wedges"), 6u * edges);
  EXPECT_EQ(primitives("shadow-volumes-zpass", "volumes"), 2u * edges);
  EXPECT_EQ(primitives("shadow-volumes-brute-force", "volumes"), 6u * 6u)
      << "three lit faces of two triangles";
}

}  // namespace soft_volumes_test
}  // namespace penumbra
