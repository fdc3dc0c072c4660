// The judge itself: against closed forms, and against Embree on the subject scenes.
#include <embree3/rtcore.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "experiments/stability/judge.h"
#include "experiments/stability/subjects.h"
#include "scenes/generators/scene_builder.h"

namespace penumbra::experiments::stability {
namespace {

constexpr std::uint32_t size = 64;

/// A plate of 1 m x 0.8 m, 1 m over the ground, under a light at (0.4, 3, -0.2), seen from above.
Scene plate_over_ground() {
  scenes::SceneBuilder b("plate", "A plate over the ground");
  const scenes::Look grey = b.look("grey", glm::vec3(0.5f), -1, 1.0, 0.0f);
  b.ground({-3.0, -3.0}, {3.0, 3.0}, grey);
  b.place(scenes::box({-0.5, 1.0, -0.4}, {0.5, 1.0000001, 0.4}), grey, "plate");
  Light& lamp = b.spot("lamp", {0.4, 3.0, -0.2}, {0.4, 0.0, -0.2}, glm::vec3(1.0f), 1.0f, 80.0, {});
  lamp.kind = LightKind::point;
  Camera& camera = b.camera("under", {0.0, 0.9, 0.0}, {0.0, 0.0, 0.0}, 130.0);
  camera.up = {0.0, 0.0, -1.0};
  camera.near_plane = 0.01;
  return b.scene;
}

glm::dvec2 ground_place(const Scene& scene, std::uint32_t x, std::uint32_t y) {
  const ViewRay view = view_ray(scene.cameras[0], {x + 0.5, y + 0.5}, size, size);
  const glm::dvec3 p = view.from - view.along * (view.from.y / view.along.y);
  return {p.x, p.z};
}

TEST(Judge, finds_the_shadow_that_similar_triangles_give) {
  const Scene scene = plate_over_ground();
  const Truth truth = judge(scene, size, size, 1);
  int judged = 0, dark = 0;
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const glm::dvec2 p = ground_place(scene, x, y);
      const float found = truth.visible[y * size + x];
      if (std::abs(p.x) > 2.9 || std::abs(p.y) > 2.9 || found < 0.0f) continue;
      // The plate is at a third of the way from the ground: light + (p - light) * 2 / 3.
      const glm::dvec2 lamp(0.4, -0.2);
      const glm::dvec2 on_plate = lamp + (p - lamp) * (2.0 / 3.0);
      const bool hidden = std::abs(on_plate.x) < 0.5 && std::abs(on_plate.y) < 0.4;
      EXPECT_EQ(found, hidden ? 0.0f : 1.0f) << x << ' ' << y;
      const double distance = glm::length(glm::dvec3(p.x - 0.4, 3.0, p.y + 0.2));
      EXPECT_NEAR(truth.light[y * size + x], 3.0 / distance, 1e-9);
      ++judged;
      dark += hidden;
    }
  EXPECT_GT(judged, 2500);
  EXPECT_GT(dark, 200);
}

TEST(Judge, leaves_out_only_pixels_beside_a_border) {
  const Scene scene = plate_over_ground();
  const Truth truth = judge(scene, size, size, 1);
  const glm::dvec2 lamp(0.4, -0.2);
  int left_out = 0, inner = 0;
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const glm::dvec2 p = ground_place(scene, x, y);
      if (std::abs(p.x) > 2.7 || std::abs(p.y) > 2.7) continue;
      ++inner;
      if (truth.visible[y * size + x] >= 0.0f) continue;
      ++left_out;
      const glm::dvec2 edge = glm::abs(lamp + (p - lamp) * (2.0 / 3.0)) - glm::dvec2(0.5, 0.4);
      const double pixel = glm::length(ground_place(scene, x + 1, y) - p) +
                           glm::length(ground_place(scene, x, y + 1) - p);
      const double off = std::max(edge.x, edge.y) < 0.0 ? -std::max(edge.x, edge.y)
                                                        : glm::length(glm::max(edge, 0.0));
      EXPECT_LT(off, 0.08 * pixel) << p.x << ' ' << p.y;
    }
  EXPECT_LT(left_out, inner / 20);
}

TEST(Judge, sees_the_share_of_a_disc_that_a_straight_edge_leaves) {
  Scene scene = plate_over_ground();
  // A plate whose edge x = 0 is as good as endless.
  scene.meshes[1] = [] {
    Mesh mesh;
    scenes::add_part(mesh, scenes::box({-2.9, 1.0, -2.9}, {0.0, 1.0000001, 2.9}), {});
    return mesh;
  }();
  const double radius = 0.5;
  scene.lights[0].extent = {ExtentKind::disc, radius, glm::dvec2(0.0)};
  const Truth truth = judge(scene, size, size, 400);
  int between = 0;
  for (std::uint32_t x = 0; x < size; ++x) {
    const std::uint32_t y = size / 2;
    const glm::dvec2 p = ground_place(scene, x, y);
    const float found = truth.visible[y * size + x];
    if (std::abs(p.x) > 2.0 || found < 0.0f) continue;
    // The edge as seen from p, in the light's plane: p + (0 - p) * 3; what lies beyond it is seen.
    const double edge = std::clamp((p.x - 3.0 * p.x - 0.4) / radius, -1.0, 1.0);
    const double share =
        (std::acos(edge) - edge * std::sqrt(1.0 - edge * edge)) / glm::pi<double>();
    EXPECT_NEAR(found, share, 0.015) << p.x;
    between += share > 0.05 && share < 0.95;
  }
  EXPECT_GE(between, 3);
}

/// Embree over a scene, in floats, with a start well above the surface.
class Embree {
 public:
  explicit Embree(const Scene& scene)
      : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.meshes[instance.mesh];
      RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* points = static_cast<glm::vec3*>(
          rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                  sizeof(glm::vec3), mesh.positions.size()));
      for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        points[i] =
            glm::vec3(instance.world_from_object * glm::dvec4(glm::dvec3(mesh.positions[i]), 1.0));
      auto* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              3 * sizeof(std::uint32_t), mesh.indices.size() / 3);
      std::copy(mesh.indices.begin(), mesh.indices.end(), static_cast<std::uint32_t*>(indices));
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_, geometry);
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_);
  }
  ~Embree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  /// 1 lit, 0 shadowed, -1 no surface or one turned away.
  int visible(const ViewRay& view, const glm::dvec3& light) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit hit{};
    set(hit.ray, view.from, view.along, 0.0f);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &hit);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return -1;
    glm::dvec3 normal = glm::normalize(glm::dvec3(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z));
    if (glm::dot(normal, view.along) > 0.0) normal = -normal;
    const glm::dvec3 from =
        view.from + static_cast<double>(hit.ray.tfar) * view.along + 2e-5 * normal;
    if (glm::dot(normal, light - from) <= 0.0) return -1;
    RTCRay ray{};
    set(ray, from, light - from, 0.0f);
    ray.tfar = 1.0f;
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0.0f ? 0 : 1;
  }

 private:
  static void set(RTCRay& ray, const glm::dvec3& from, const glm::dvec3& along, float near) {
    ray.org_x = static_cast<float>(from.x);
    ray.org_y = static_cast<float>(from.y);
    ray.org_z = static_cast<float>(from.z);
    ray.dir_x = static_cast<float>(along.x);
    ray.dir_y = static_cast<float>(along.y);
    ray.dir_z = static_cast<float>(along.z);
    ray.tnear = near;
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = 0xffffffffu;
  }

  RTCDevice device_;
  RTCScene scene_;
};

void expect_agreement(const Scene& scene) {
  const Truth truth = judge(scene, 96, 96, 1);
  const Embree embree(scene);
  int judged = 0, dark = 0, different = 0;
  for (std::uint32_t y = 0; y < 96; ++y)
    for (std::uint32_t x = 0; x < 96; ++x) {
      const float found = truth.visible[y * 96 + x];
      const int other = embree.visible(view_ray(scene.cameras[0], {x + 0.5, y + 0.5}, 96, 96),
                                       scene.lights[0].position);
      if (found < 0.0f || other < 0) continue;
      ++judged;
      dark += other == 0;
      different += found != static_cast<float>(other);
    }
  EXPECT_GT(judged, 3000);
  EXPECT_GT(dark, 200);
  EXPECT_EQ(different, 0);
}

TEST(Judge, agrees_with_embree_on_every_firm_pixel_of_the_subject) {
  expect_agreement(askew(subject()));
}

TEST(Judge, agrees_with_embree_where_crates_coincide_or_are_broken) {
  expect_agreement(askew(subject({.copies = 3})));
  for (const Defect defect :
       {Defect::doubled_triangles, Defect::empty_triangles, Defect::t_junctions})
    expect_agreement(askew(broken_subject(defect)));
}

TEST(Judge, agrees_with_embree_under_plates) {
  expect_agreement(askew(stack(33, 0.004)));
}

TEST(Judge, sees_through_the_backs_of_what_is_single_sided) {
  // The camera is under the plate and looks down: a sheet between, facing down, shows its back.
  Scene scene = plate_over_ground();
  const Truth open = judge(scene, size, size, 1);
  Mesh sheet;
  scenes::Solid solid;
  for (const glm::dvec3 p : {glm::dvec3(-0.1, 0.5, -0.1), glm::dvec3(0.1, 0.5, -0.1),
                             glm::dvec3(0.1, 0.5, 0.1), glm::dvec3(-0.1, 0.5, 0.1)})
    solid.add_point(p);
  solid.add_quad(0, 1, 2, 3);
  scenes::add_part(sheet, solid, {});
  scene.meshes.push_back(sheet);
  scene.instances.push_back({"sheet", 2, glm::dmat4(1.0), false});
  const auto light_in_middle = [&](const Scene& of) {
    return judge(of, size, size, 1).light[size / 2 * size + size / 2];
  };
  // On the ground the light of the middle is known; the sheet is nearer to it.
  const double on_ground = open.light[size / 2 * size + size / 2];
  EXPECT_EQ(light_in_middle(scene), on_ground);
  scene.materials[0].double_sided = true;
  EXPECT_LT(light_in_middle(scene), on_ground);
  // Mirrored, it faces up.
  scene.materials[0].double_sided = false;
  scene.instances.back().world_from_object[1][1] = -1.0;
  scene.instances.back().world_from_object[3][1] = 1.0;
  EXPECT_LT(light_in_middle(scene), on_ground);
  for (auto& triangle : solid.triangles) std::swap(triangle[1], triangle[2]);
  scene.meshes.back() = Mesh{};
  scenes::add_part(scene.meshes.back(), solid, {});
  scene.instances.back().world_from_object = glm::dmat4(1.0);
  EXPECT_LT(light_in_middle(scene), on_ground);
}

TEST(Judge, does_not_change_when_the_scene_moves_as_a_whole) {
  const Scene still = askew(subject());
  const Truth truth = judge(still, size, size, 1);
  for (const double factor : {1e-4, 1.0, 1e6}) {
    const Truth other =
        judge(moved(still, factor, 33.0, glm::dvec3(2.0, -7.0, 5.0) * factor), size, size, 1);
    int different = 0;
    for (std::size_t i = 0; i < truth.visible.size(); ++i)
      different += std::abs(truth.visible[i] - other.visible[i]) == 1.0f;
    EXPECT_EQ(different, 0) << factor;
  }
}

}  // namespace
}  // namespace penumbra::experiments::stability
