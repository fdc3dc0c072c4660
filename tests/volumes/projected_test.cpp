// Projected planar shadows against volumes and rays, which know no planes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/error.h"
#include "tests/volumes/drawing.h"
#include "tests/volumes/exact_rays.h"

namespace penumbra {
namespace {

using test::draw;
using test::ground_point;
using test::size;

/// A floating box; a second box at the side whose top is no receiver.
Scene two_boxes(LightKind kind) {
  scenes::SceneBuilder b("two-boxes", "A box over the ground and one beside its shadow");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-2.0, -2.0}, {2.0, 2.0}, look);
  b.place(scenes::box({-0.3, 1.0, -0.3}, {0.4, 1.3, 0.4}), look, "high");
  b.place(scenes::box({-0.9, 0.0, -0.4}, {-0.3, 0.2, 0.3}), look, "low");
  b.spot("lamp", {1.5, 4.0, 0.7}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 60.0, LightExtent{})
      .kind = kind;
  b.camera("main", {1.2, 3.4, 3.4}, {-0.2, 0.2, -0.1}, 45.0);
  return b.scene;
}

bool on_ground(const Scene& scene, std::uint32_t x, std::uint32_t y) {
  const glm::dvec3 p = ground_point(scene.cameras[0], x, y);
  const glm::dvec3 eye = scene.cameras[0].position;
  return std::max(std::abs(p.x), std::abs(p.z)) < 1.99 &&
         !test::meets_box(p, eye, {-0.31, 0.99, -0.31}, {0.41, 1.31, 0.41}) &&
         !test::meets_box(p, eye, {-0.91, 0.0, -0.41}, {-0.29, 0.21, 0.31});
}

class Lights : public testing::TestWithParam<LightKind> {};

TEST_P(Lights, throw_the_shadow_of_the_volumes_on_the_plane_and_none_elsewhere) {
  const Scene scene = two_boxes(GetParam());
  const RenderResult projected = draw(scene, "projected");
  const RenderResult volumes = draw(scene, "shadow-volumes");
  int ground = 0, shadowed = 0, different = 0, others_shadowed = 0, others_lit_wrongly = 0;
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      if (volumes.judged.at(x, y, 0) < 1.0f) continue;
      const float a = projected.visibility.at(x, y, 0);
      const float b = volumes.visibility.at(x, y, 0);
      const glm::dvec3 p = ground_point(scene.cameras[0], x, y);
      if (on_ground(scene, x, y)) {
        ++ground;
        shadowed += b == 0.0f;
        different += a != b;
      } else if (test::meets_box(p, scene.cameras[0].position, {-0.89, 0.19, -0.39},
                                 {-0.31, 0.21, 0.29})) {
        others_shadowed += b == 0.0f;
        others_lit_wrongly += a != 1.0f;
      }
    }
  EXPECT_GT(ground, 5000);
  EXPECT_GT(shadowed, 200);
  EXPECT_LE(different, 3) << "by rounding at the border";
  EXPECT_GT(others_shadowed, 20) << "the low box lies in the shadow";
  EXPECT_EQ(others_lit_wrongly, 0) << "and is no receiver";
}

INSTANTIATE_TEST_SUITE_P(Of, Lights,
                         testing::Values(LightKind::spot, LightKind::point,
                                         LightKind::directional));

TEST(Projected, ends_shadows_at_the_receivers_border) {
  Scene scene = two_boxes(LightKind::spot);
  for (glm::dvec3& corner : scene.receivers[0].corners) corner.x = std::max(corner.x, -0.5);
  const RenderResult result = draw(scene, "projected");
  int dark_inside = 0;
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      if (result.judged.at(x, y, 0) < 1.0f || !on_ground(scene, x, y)) continue;
      const double at = ground_point(scene.cameras[0], x, y).x;
      if (at < -0.505) {
        EXPECT_EQ(result.visibility.at(x, y, 0), 1.0f);
      }
      if (at > -0.495) dark_inside += result.visibility.at(x, y, 0) == 0.0f;
    }
  EXPECT_GT(dark_inside, 100);
}

TEST(Projected, serves_several_planes_that_lie_anyhow) {
  Scene scene = two_boxes(LightKind::spot);
  // Everything turned: the plane is no longer y = 0; the picture must stay.
  const RenderResult upright = draw(scene, "projected");
  const glm::dmat4 turn =
      glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1.0, 0.4, -0.6)));
  const auto turned = [&](const glm::dvec3& v) { return glm::dvec3(turn * glm::dvec4(v, 1.0)); };
  for (Instance& instance : scene.instances)
    instance.world_from_object = turn * instance.world_from_object;
  for (Light& light : scene.lights) {
    light.position = turned(light.position);
    light.direction = turned(light.direction);
    light.up = turned(light.up);
  }
  for (Camera& camera : scene.cameras) {
    camera.position = turned(camera.position);
    camera.target = turned(camera.target);
    camera.up = turned(camera.up);
  }
  for (glm::dvec3& corner : scene.receivers[0].corners) corner = turned(corner);
  scene.receivers.push_back(scene.receivers[0]);  // twice the same darkens once
  const RenderResult result = draw(scene, "projected");
  int different = 0;
  for (std::size_t i = 0; i < result.visibility.pixels.size(); ++i)
    different += result.judged.pixels[i] == 1.0f && upright.judged.pixels[i] == 1.0f &&
                 result.visibility.pixels[i] != upright.visibility.pixels[i];
  EXPECT_LE(different, 5) << "by rounding at the border";
}

/// A box before a floor, a wall and a ramp, all receivers, under a lamp, a point light and a sun.
Scene three_planes() {
  scenes::SceneBuilder b("three-planes", "A box before floor, wall and ramp");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-2.0, -2.0}, {2.0, 2.0}, look);
  b.place(scenes::box({-2.0, 0.0, -2.1}, {2.0, 2.5, -2.0}), look, "wall");
  b.scene.receivers.push_back(
      {"wall", {{-2.0, 0.0, -2.0}, {2.0, 0.0, -2.0}, {2.0, 2.5, -2.0}, {-2.0, 2.5, -2.0}}});
  const glm::dmat4 tilted = glm::translate(glm::dmat4(1.0), glm::dvec3(-1.3, 0.3, -0.2)) *
                            glm::rotate(glm::dmat4(1.0), -0.5, glm::dvec3(0.2, 0.1, 1.0));
  b.place(scenes::box({-0.5, -0.05, -0.8}, {0.5, 0.0, 0.8}), look, "ramp", tilted);
  PlanarReceiver ramp{"ramp", {}};
  for (const glm::dvec2 at : {glm::dvec2(-0.5, -0.8), {-0.5, 0.8}, {0.5, 0.8}, {0.5, -0.8}})
    ramp.corners.emplace_back(tilted * glm::dvec4(at.x, 0.0, at.y, 1.0));
  b.scene.receivers.push_back(ramp);
  b.place(scenes::box({-0.4, 0.8, -0.9}, {0.2, 1.3, -0.4}), look, "box",
          glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(0.3, 1.0, 0.1)));
  b.place(scenes::box({-1.5, 0.8, -0.3}, {-1.1, 0.9, 0.1}), look, "plate");
  b.spot("lamp", {0.2, 3.4, 1.6}, {-0.3, 0.6, -0.8}, glm::vec3(1.0f), 0.5f, 50.0, LightExtent{});
  b.spot("bulb", {0.6, 2.2, 0.9}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 0.5f, 50.0, LightExtent{})
      .kind = LightKind::point;
  b.spot("sun", {0.3, 1.2, 2.0}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 0.5f, 50.0, LightExtent{}).kind =
      LightKind::directional;
  b.camera("main", {1.6, 2.2, 3.4}, {-0.4, 0.6, -0.6}, 50.0);
  return b.scene;
}

TEST(Projected, falls_on_every_plane_from_every_light_as_rays_have_it) {
  const Scene scene = three_planes();
  ASSERT_EQ(scene.receivers.size(), 3u);
  ASSERT_EQ(scene.lights.size(), 3u);
  const RenderResult result = draw(scene, "projected");
  const std::vector<int> truth = test::exact_visibility(scene, {}, size);
  const test::ExactRays rays(scene);
  int shadowed[3][3] = {}, wrong[3][3] = {};
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const test::Ray view = test::camera_ray(scene.cameras[0], x, y, size);
      const auto hit = rays.nearest(view.from, view.along, 0.1);
      if (!hit) continue;
      const glm::dvec3 point = view.from + hit->distance * view.along;
      for (std::size_t r = 0; r < 3; ++r) {
        const auto& corners = scene.receivers[r].corners;
        const glm::dvec3 normal =
            glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
        if (std::abs(glm::dot(normal, point - corners[0])) > 1e-6 ||
            glm::dot(normal, hit->normal) < 0.999)
          continue;
        for (std::uint32_t light = 0; light < 3; ++light) {
          const int exact = truth[(std::size_t{y} * size + x) * 3 + light];
          if (result.judged.at(x, y, light) < 1.0f || exact < 0) continue;
          shadowed[r][light] += exact == 0;
          wrong[r][light] += result.visibility.at(x, y, light) != static_cast<float>(exact);
        }
      }
    }
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t light = 0; light < 3; ++light) {
      const auto name = scene.receivers[r].name + " under " + scene.lights[light].name;
      EXPECT_GT(shadowed[r][light], 20) << name;
      EXPECT_LE(wrong[r][light], 3) << name << ", of " << shadowed[r][light];
    }
}

TEST(Projected, throws_nothing_from_casters_beyond_the_light_or_below_the_plane) {
  Scene scene = two_boxes(LightKind::point);
  scene.instances[1].world_from_object = glm::translate(glm::dmat4(1.0), {0.0, 4.0, 0.0});
  scene.instances[2].world_from_object = glm::translate(glm::dmat4(1.0), {0.0, -1.0, 0.0});
  const RenderResult result = draw(scene, "projected");
  for (std::size_t i = 0; i < result.visibility.pixels.size(); ++i)
    if (result.judged.pixels[i] == 1.0f) {
      ASSERT_EQ(result.visibility.pixels[i], 1.0f);
    }
}

TEST(Projected, answers_unsupported_where_the_scene_declares_no_receiver) {
  Scene scene = two_boxes(LightKind::spot);
  scene.receivers.clear();
  try {
    draw(scene, "projected");
    FAIL() << "a picture was drawn";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "unsupported");
    EXPECT_THAT(error.what(), testing::HasSubstr("receivers"));
  }
}

}  // namespace
}  // namespace penumbra
