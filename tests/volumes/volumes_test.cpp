// Shadow volumes against closed forms and against rays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/error.h"
#include "tests/kept_pictures/kept_pictures.h"
#include "tests/volumes/drawing.h"

namespace penumbra {
namespace volumes_test {

using test::draw;
using test::ground_point;
using test::meets_box;
using test::size;

const glm::dvec3 box_low(-0.4, 0.5, -0.3);
const glm::dvec3 box_high(0.5, 0.9, 0.4);

/// A box that floats over the ground, under a light of this kind.
Scene floating_box(LightKind kind, Projection projection) {
  scenes::SceneBuilder b("floating-box", "A box over the ground");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-3.0, -3.0}, {3.0, 3.0}, look);
  b.place(scenes::box(box_low, box_high), look, "box");
  Light& light =
      b.spot("lamp", {1.1, 3.0, 0.7}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 60.0, LightExtent{});
  light.kind = kind;
  b.camera("main", {2.0, 2.6, 3.4}, {-0.2, 0.2, -0.1}, 50.0);
  b.scene.cameras[0].projection = projection;
  b.scene.cameras[0].orthographic_height = 4.0;
  return b.scene;
}

/// 0 where the ground at `point` is shadowed by the box, 1 where it is lit, -1 so near the border
/// that rounding decides.
int truth_at(const Light& light, const glm::dvec3& point) {
  const glm::dvec3 to =
      light.kind == LightKind::directional ? point - 100.0 * light.direction : light.position;
  const glm::dvec3 margin(1e-4);
  const bool grown = meets_box(point, to, box_low - margin, box_high + margin);
  const bool shrunk = meets_box(point, to, box_low + margin, box_high - margin);
  return grown != shrunk ? -1 : grown ? 0 : 1;
}

struct Judged {
  int shadowed = 0, lit = 0, wrong = 0;
};

/// Compares every pixel that shows the ground with the truth.
Judged judge(const Scene& scene, const RenderResult& result) {
  Judged judged;
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const Camera& camera = scene.cameras[0];
      const glm::dvec3 point = ground_point(camera, x, y);
      const bool parallel = camera.projection == Projection::orthographic;
      const glm::dvec3 eye = parallel
                                 ? point - 20.0 * glm::normalize(camera.target - camera.position)
                                 : camera.position;
      const glm::dvec3 margin(0.01);
      if (result.judged.at(x, y, 0) < 1.0f ||
          meets_box(point, eye, box_low - margin, box_high + margin))
        continue;
      const int truth = truth_at(scene.lights[0], point);
      if (truth < 0) continue;
      ++(truth == 0 ? judged.shadowed : judged.lit);
      judged.wrong += result.visibility.at(x, y, 0) != static_cast<float>(truth);
    }
  return judged;
}

class Kinds : public testing::TestWithParam<std::tuple<LightKind, Projection, const char*>> {};

TEST_P(Kinds, shadow_the_ground_exactly_where_a_box_hides_the_light) {
  const auto [kind, projection, technique] = GetParam();
  const Scene scene = floating_box(kind, projection);
  for (const bool clamp : {false, true}) {
    const Judged judged = judge(scene, draw(scene, technique, {{"clamp", clamp}}));
    EXPECT_GT(judged.shadowed, 400);
    EXPECT_GT(judged.lit, 4000);
    EXPECT_EQ(judged.wrong, 0) << "clamp " << clamp;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, Kinds,
    testing::Combine(testing::Values(LightKind::spot, LightKind::point, LightKind::directional),
                     testing::Values(Projection::perspective, Projection::orthographic),
                     testing::Values("shadow-volumes", "shadow-volumes-zpass",
                                     "shadow-volumes-zpass-plus", "shadow-volumes-brute-force")));

class BuiltInScenes : public testing::TestWithParam<const char*> {};

TEST_P(BuiltInScenes, look_the_same_with_and_without_clamping) {
  const Scene scene = *scenes::load(GetParam());
  const RenderResult whole = draw(scene, "shadow-volumes");
  const RenderResult clamped = draw(scene, "shadow-volumes", {{"clamp", true}});
  const auto error = tests::visibility_error(clamped.visibility, whole.visibility, whole.judged);
  EXPECT_LE(error.false_shadow + error.missing_shadow, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Of, BuiltInScenes,
                         testing::Values("boxes", "disco-box", "car", "camera-in-volume",
                                         "leaky-box", "contact"));

TEST(ShadowVolumes, clamping_draws_fewer_fragments) {
  const Scene scene = *scenes::load("camera-in-volume");
  const auto fragments = [&](bool clamp) {
    for (const PassCost& pass : draw(scene, "shadow-volumes", {{"clamp", clamp}}).cost.passes)
      if (pass.name == "volumes") return pass.fragment_invocations;
    return std::uint64_t{0};
  };
  EXPECT_LT(fragments(true), fragments(false));
}

/// Share of the judged pixels on which two pictures agree.
double agreement(const RenderResult& a, const RenderResult& b) {
  double judged = 0.0;
  double alike = 0.0;
  for (std::size_t i = 0; i < a.judged.pixels.size(); ++i) {
    if (a.judged.pixels[i] < 1.0f) continue;
    ++judged;
    alike += a.visibility.pixels[i] == b.visibility.pixels[i];
  }
  return alike / judged;
}

TEST(ShadowVolumes, z_pass_inverts_where_the_camera_is_in_a_volume_and_others_do_not) {
  const Scene scene = *scenes::load("camera-in-volume");
  const RenderResult rays = draw(scene, "ray-traced", {{"rays", std::int64_t{1}}});
  EXPECT_GT(agreement(draw(scene, "shadow-volumes"), rays), 0.999);
  EXPECT_GT(agreement(draw(scene, "shadow-volumes-zpass-plus"), rays), 0.999);
  EXPECT_LT(agreement(draw(scene, "shadow-volumes-zpass"), rays), 0.5);
  const RenderResult rays_aside = draw(scene, "ray-traced", {{"rays", std::int64_t{1}}}, "side");
  EXPECT_GT(agreement(draw(scene, "shadow-volumes-zpass", {}, "side"), rays_aside), 0.999);
}

/// Something hangs between light and camera, so near that its shadow ends within the near plane.
Scene near_plane_half_shadowed(LightKind kind, Projection projection) {
  Scene scene = floating_box(kind, projection);
  Camera& camera = scene.cameras[0];
  camera.near_plane = 0.4;
  const glm::dvec3 forward = glm::normalize(camera.target - camera.position);
  const glm::dvec3 to_light = kind == LightKind::directional
                                  ? -scene.lights[0].direction
                                  : glm::normalize(scene.lights[0].position - camera.position);
  Instance pole = scene.instances[1];
  // A box a third as wide as what is seen there, towards the light from the middle of the near
  // plane.
  const double scale = projection == Projection::perspective ? 0.25 : 1.4;
  pole.world_from_object = glm::translate(glm::dmat4(1.0), camera.position + 0.4 * forward +
                                                               (0.4 + 0.8 * scale) * to_light) *
                           glm::scale(glm::dmat4(1.0), glm::dvec3(scale)) *
                           glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.7, 0.0));
  scene.instances.push_back(pole);
  return scene;
}

class NearPlanes : public testing::TestWithParam<std::tuple<LightKind, Projection>> {};

TEST_P(NearPlanes, may_lie_partly_in_shadow_but_for_z_pass) {
  const auto [kind, projection] = GetParam();
  const Scene scene = near_plane_half_shadowed(kind, projection);
  const RenderResult rays = draw(scene, "ray-traced", {{"rays", std::int64_t{1}}});
  EXPECT_LT(agreement(draw(scene, "shadow-volumes-zpass"), rays), 0.97) << "the case is there";
  EXPECT_GT(agreement(draw(scene, "shadow-volumes-zpass-plus"), rays), 0.998);
  const RenderResult behind = draw(scene, "shadow-volumes");
  const RenderResult automatic =
      draw(scene, "shadow-volumes", {{"counting", std::string("automatic")}});
  EXPECT_GT(agreement(behind, rays), 0.999);
  EXPECT_GT(agreement(automatic, behind), 0.9995);
}

INSTANTIATE_TEST_SUITE_P(Of, NearPlanes,
                         testing::Combine(testing::Values(LightKind::spot, LightKind::directional),
                                          testing::Values(Projection::perspective,
                                                          Projection::orthographic)));

const PassCost& volumes_pass(const RenderResult& result) {
  for (const PassCost& pass : result.cost.passes)
    if (pass.name == "volumes") return pass;
  throw std::logic_error("no volumes were drawn");
}

TEST(ShadowVolumes, are_counted_before_the_surface_where_the_camera_is_provably_outside) {
  const Scene scene = floating_box(LightKind::spot, Projection::perspective);
  const RenderResult behind = draw(scene, "shadow-volumes");
  const RenderResult automatic =
      draw(scene, "shadow-volumes", {{"counting", std::string("automatic")}});
  const RenderResult before = draw(scene, "shadow-volumes-zpass");
  EXPECT_TRUE(tests::same(automatic.visibility, behind.visibility));
  EXPECT_EQ(volumes_pass(automatic).geometry_primitives, volumes_pass(before).geometry_primitives)
      << "no caps are drawn";
  EXPECT_GT(volumes_pass(behind).geometry_primitives, volumes_pass(before).geometry_primitives);
}

TEST(ShadowVolumes, are_the_same_with_a_two_sided_stencil_and_in_two_passes) {
  const Scene scene = *scenes::load("disco-box");
  for (const char* technique : {"shadow-volumes", "shadow-volumes-zpass"}) {
    const RenderResult one = draw(scene, technique);
    const RenderResult two = draw(scene, technique, {{"stencil_passes", std::int64_t{2}}});
    EXPECT_TRUE(tests::same(one.visibility, two.visibility)) << technique;
    EXPECT_EQ(2 * volumes_pass(one).primitives, volumes_pass(two).primitives) << technique;
  }
}

/// Plates above each other, so that the ground below lies in as many volumes.
Scene stack(int plates) {
  scenes::SceneBuilder b("stack", "Plates above each other");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-3.0, -3.0}, {3.0, 3.0}, look);
  for (int i = 0; i < plates; ++i)
    b.place(scenes::box({-0.5, 1.0 + 0.004 * i, -0.5}, {0.5, 1.002 + 0.004 * i, 0.5}), look,
            "plate " + std::to_string(i));
  b.spot("lamp", {0.0, 4.0, 0.0}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 50.0, LightExtent{});
  b.camera("main", {0.0, 0.6, 4.0}, {0.0, 0.0, 0.0}, 25.0);
  return b.scene;
}

TEST(ShadowVolumes, are_dark_under_any_number_of_overlaps) {
  // The middle of the picture shows the ground below the plates.
  const auto middle = [](int plates) {
    return draw(stack(plates), "shadow-volumes").visibility.at(size / 2, size / 2, 0);
  };
  EXPECT_EQ(middle(0), 1.0f);
  EXPECT_EQ(middle(1), 0.0f);
  EXPECT_EQ(middle(255), 0.0f);
  EXPECT_EQ(middle(256), 0.0f);
  EXPECT_EQ(middle(257), 0.0f);
}

TEST(ShadowVolumes, count_nothing_on_ground_that_no_shadow_meets) {
  Scene scene = floating_box(LightKind::spot, Projection::perspective);
  const auto resolved = techniques::resolve("shadow-volumes");
  RenderRequest request;
  request.scene = std::make_shared<const Scene>(scene);
  request.technique = resolved.technique;
  request.width = request.height = size;
  request.diagnostic = "count";
  const Image8 counts = test::renderer().render(request).diagnostic;
  int grey = 0;
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const glm::dvec3 point = ground_point(scene.cameras[0], x, y);
      if (std::max(std::abs(point.x), std::abs(point.z)) > 2.9 ||
          meets_box(point, scene.cameras[0].position, box_low - 0.01, box_high + 0.01) ||
          truth_at(scene.lights[0], point) != 1)
        continue;
      ++grey;
      EXPECT_EQ(counts.at(x, y, 0), counts.at(x, y, 2)) << x << ' ' << y;
    }
  EXPECT_GT(grey, 4000);
}

/// One quadrangle over the ground, wound upwards or downwards.
Scene sheet(bool upwards, bool double_sided) {
  Scene scene = floating_box(LightKind::point, Projection::perspective);
  Mesh& mesh = scene.meshes[scene.instances[1].mesh];
  const double y = box_high.y;
  mesh.positions = {{box_low.x, y, box_low.z},
                    {box_low.x, y, box_high.z},
                    {box_high.x, y, box_high.z},
                    {box_high.x, y, box_low.z}};
  mesh.normals.assign(4, glm::vec3(0.0f, upwards ? 1.0f : -1.0f, 0.0f));
  mesh.uvs.clear();
  mesh.colors.clear();
  mesh.indices = upwards ? std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}
                         : std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2};
  mesh.primitives = {{0, 6, mesh.primitives[0].material}};
  for (Material& material : scene.materials) material.double_sided = double_sided;
  return scene;
}

TEST(ShadowVolumes, of_an_open_sheet_are_the_same_whichever_way_it_looks) {
  for (const bool upwards : {true, false})
    for (const bool double_sided : {true, false}) {
      const Scene scene = sheet(upwards, double_sided);
      const RenderResult rays = draw(scene, "ray-traced", {{"rays", std::int64_t{1}}});
      const RenderResult volumes = draw(scene, "shadow-volumes");
      EXPECT_GT(agreement(volumes, rays), 0.9995)
          << (upwards ? "up" : "down") << (double_sided ? ", double-sided" : "");
    }
}

TEST(ShadowVolumes, pay_for_adjacency_with_twice_the_bytes_of_the_indices_whatever_the_lights) {
  const Scene scene = *scenes::load("disco-box");  // three lights
  std::uint64_t index_bytes = 0;
  for (const Instance& instance : scene.instances)
    index_bytes += scene.meshes[instance.mesh].indices.size() * 4;
  std::uint64_t adjacency = 0;
  for (const ResourceCost& resource : draw(scene, "shadow-volumes").cost.technique_memory)
    if (resource.name == "adjacency") adjacency = resource.bytes;
  EXPECT_EQ(adjacency, 2 * index_bytes);
}

TEST(ShadowVolumes, say_that_they_ignore_masks) {
  Scene scene = floating_box(LightKind::spot, Projection::perspective);
  EXPECT_THAT(draw(scene, "shadow-volumes").notes, testing::IsEmpty());
  for (Material& material : scene.materials) material.alpha_mode = AlphaMode::mask;
  EXPECT_THAT(draw(scene, "shadow-volumes").notes, testing::IsEmpty()) << "without holes";
  Mesh& mesh = scene.meshes.back();
  mesh.colors.assign(mesh.positions.size(), glm::vec4(1.0f));
  mesh.colors.front().a = 0.0f;
  EXPECT_THAT(draw(scene, "shadow-volumes").notes,
              testing::Contains(testing::HasSubstr("ignore alpha masks")));
}

TEST(ShadowVolumes, say_which_casters_are_no_closed_bodies) {
  Scene scene = floating_box(LightKind::spot, Projection::perspective);
  Mesh& mesh = scene.meshes.back();
  // A fin on an edge that two triangles share already.
  const auto fin = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back(mesh.positions[0] + glm::vec3(0.0f, 5.0f, 0.0f));
  mesh.normals.push_back({1, 0, 0});
  if (!mesh.uvs.empty()) mesh.uvs.push_back({0, 0});
  mesh.indices.insert(mesh.indices.end(), {mesh.indices[0], mesh.indices[1], fin});
  mesh.primitives.back().index_count += 3;
  EXPECT_THAT(draw(scene, "shadow-volumes").notes,
              testing::UnorderedElementsAre(testing::HasSubstr("as silhouettes: 1"),
                                            testing::HasSubstr("closest normals: 1")));
}

TEST(ShadowVolumes, by_brute_force_draw_many_times_the_fragments_of_silhouettes) {
  const Scene scene = *scenes::load("sweep:4x1600x1");
  const auto fragments = [&](const char* technique) {
    return static_cast<double>(volumes_pass(draw(scene, technique)).fragment_invocations);
  };
  EXPECT_GT(fragments("shadow-volumes-brute-force"), 4.0 * fragments("shadow-volumes-zpass"));
}

TEST(ShadowVolumes, grow_with_silhouettes_and_not_with_triangles) {
  const auto sides = [](const char* scene, const char* technique) {
    return static_cast<double>(
        volumes_pass(draw(*scenes::load(scene), technique)).geometry_primitives);
  };
  // The knot of a sweep has the same shape at every count: 16 times the triangles of one body have
  // about 4 times the silhouette edges.
  EXPECT_NEAR(sides("sweep:4x1600x1", "shadow-volumes-brute-force") /
                  sides("sweep:4x100x1", "shadow-volumes-brute-force"),
              16.0, 3.0);
  EXPECT_NEAR(sides("sweep:4x1600x1", "shadow-volumes-zpass") /
                  sides("sweep:4x100x1", "shadow-volumes-zpass"),
              4.0, 1.5);
}

TEST(ShadowVolumes, by_brute_force_draw_more_primitives_than_silhouettes_do) {
  const Scene scene = *scenes::load("contact");
  const auto primitives = [&](const char* technique) {
    for (const PassCost& pass : draw(scene, technique).cost.passes)
      if (pass.name == "volumes") return pass.geometry_primitives;
    return std::uint64_t{0};
  };
  EXPECT_GT(primitives("shadow-volumes-brute-force"), 2 * primitives("shadow-volumes-zpass"));
}

}  // namespace volumes_test
}  // namespace penumbra
