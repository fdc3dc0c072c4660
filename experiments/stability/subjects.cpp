#include "experiments/stability/subjects.h"

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene/light.h"
#include "scenes/generators/scene_builder.h"

namespace penumbra::experiments::stability {
namespace {

using scenes::Solid;

constexpr double flat = 1.0;  ///< crease, degrees: every facet keeps its own normal

const glm::dvec3 skew_axis = glm::normalize(glm::dvec3(0.36, 0.48, 0.8));

const glm::dvec3 lamp_place{-2.2, 6.2, 2.6};

/// The crate's solid around its own middle, 1 m wide.
Solid crate(double thickness) {
  return scenes::box({-0.5, -0.5 * thickness, -0.5}, {0.5, 0.5 * thickness, 0.5});
}

/// A disc of radius 0.5 around the origin, facing up, of `count` triangles that all meet in its
/// middle; as a closed plate.
Solid sliver_disc(std::uint32_t count) {
  return scenes::cylinder(0.5, 0.5, 0.05, static_cast<int>(count));
}

glm::dmat4 translation(const glm::dvec3& by) {
  return glm::translate(glm::dmat4(1.0), by);
}

glm::dmat4 crate_place(const SubjectShape& shape) {
  return translation({-0.4, shape.gap + 0.5 * shape.thickness, 0.1}) *
         glm::rotate(glm::dmat4(1.0), glm::radians(27.0), glm::dvec3(0, 1, 0)) *
         glm::scale(glm::dmat4(1.0), {shape.mirrored ? -1.0 : 1.0, 1.0, shape.squash});
}

scenes::SceneBuilder builder() {
  scenes::SceneBuilder b("subject", "A subject of the stability report");
  b.scene.ambient = glm::vec3(0.08f);
  return b;
}

void light_and_camera(scenes::SceneBuilder& b) {
  Light& lamp =
      b.spot("lamp", lamp_place, {0.0, 0.4, 0.0}, glm::vec3(1.0f), 1.0f, 35.0, LightExtent{});
  lamp.up = {0.0, 0.0, 1.0};
  b.camera("main", {2.5, 3.0, 5.0}, {0.1, 0.5, 0.0}, 40.0);
}

Scene assembled(const SubjectShape& shape, const Solid& crate_solid) {
  scenes::SceneBuilder b = builder();
  const scenes::Look grey = b.look("grey", glm::vec3(0.7f), -1, 1.0, 0.0f);
  b.ground({-shape.ground, -shape.ground}, {shape.ground, shape.ground}, grey);
  for (std::uint32_t i = 0; i < shape.copies; ++i)
    b.place(crate_solid, grey, "crate " + std::to_string(i), crate_place(shape), flat);
  b.place(scenes::sphere(0.4, 16, 11), grey, "ball", translation({1.1, 0.9, -0.5}), flat);
  b.place(scenes::box({-0.5 * shape.post, 0.1, -0.5 * shape.post},
                      {0.5 * shape.post, 1.4, 0.5 * shape.post}),
          grey, "post", translation({0.7, 0.0, 0.9}), flat);
  if (shape.slivers > 0)
    b.place(sliver_disc(shape.slivers), grey, "disc", translation({-0.4, 1.6, 0.1}), flat);
  if (shape.outlier > 0.0)
    b.place(crate_solid, grey, "outlier",
            translation(shape.outlier * glm::normalize(glm::dvec3(0.6, 0.1, 0.9))), flat);
  light_and_camera(b);
  return b.scene;
}

Solid broken_crate(Defect defect) {
  Solid solid = crate(1.0);
  auto& triangles = solid.triangles;
  switch (defect) {
    case Defect::none:
      break;
    case Defect::doubled_triangles: {
      const auto once = triangles;
      triangles.insert(triangles.end(), once.begin(), once.end());
      break;
    }
    case Defect::empty_triangles:
      for (std::uint32_t i = 0; i < 8; ++i) triangles.push_back({i, i, (i + 1) % 8});
      break;
    case Defect::t_junctions: {
      // Corner in the middle of one triangle's side, which its neighbour does not have.
      const auto [a, b, c] = triangles.back();
      const std::uint32_t middle = solid.add_point(0.5 * (solid.points[a] + solid.points[b]));
      triangles.back() = {a, middle, c};
      triangles.push_back({middle, b, c});
      break;
    }
    case Defect::inside_out:
      for (auto& triangle : triangles) std::swap(triangle[1], triangle[2]);
      break;
    case Defect::face_turned:
      for (std::size_t i = 6; i < 8; ++i) std::swap(triangles[i][1], triangles[i][2]);
      break;
    case Defect::face_missing:
      triangles.erase(triangles.begin() + 6, triangles.begin() + 8);
      break;
  }
  return solid;
}

}  // namespace

Scene subject(const SubjectShape& shape) {
  return assembled(shape, crate(shape.thickness));
}

glm::dvec3 shadow_border() {
  const glm::dvec3 edge(crate_place({}) * glm::dvec4(0.5, 0.5, 0.0, 1.0));
  return lamp_place + (edge - lamp_place) * (lamp_place.y / (lamp_place.y - edge.y));
}

Scene stack(std::uint32_t count, double thickness) {
  scenes::SceneBuilder b = builder();
  const scenes::Look grey = b.look("grey", glm::vec3(0.7f), -1, 1.0, 0.0f);
  b.ground({-6.0, -6.0}, {6.0, 6.0}, grey);
  const std::uint32_t mesh = [&] {
    Mesh plate;
    scenes::add_part(plate, scenes::box({-0.6, 0.0, -0.5}, {0.6, thickness, 0.5}), grey,
                     glm::dmat4(1.0), flat);
    return b.add_mesh("plate", std::move(plate));
  }();
  // Half of each step is air, so that plates never touch.
  for (std::uint32_t i = 0; i < count; ++i)
    b.place(mesh, translation({0.0, 0.4 + 2.0 * thickness * i, 0.0}), "plate " + std::to_string(i));
  light_and_camera(b);
  return b.scene;
}

Scene askew(Scene upright) {
  return moved(std::move(upright), 1.0, 41.0, {0.0, 0.0, 0.0});
}

Scene moved(Scene scene, double factor, double degrees, const glm::dvec3& offset) {
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), glm::radians(degrees), skew_axis);
  const glm::dmat4 all =
      translation(offset) * turn * glm::scale(glm::dmat4(1.0), glm::dvec3(factor));
  const auto place = [&](const glm::dvec3& p) { return glm::dvec3(all * glm::dvec4(p, 1.0)); };
  const auto way = [&](const glm::dvec3& d) { return glm::dvec3(turn * glm::dvec4(d, 0.0)); };
  for (Instance& instance : scene.instances)
    instance.world_from_object = all * instance.world_from_object;
  for (Light& light : scene.lights) {
    light.position = place(light.position);
    light.direction = glm::normalize(way(light.direction));
    light.up = way(light.up);
    scale_lengths(light, factor);
  }
  for (Camera& camera : scene.cameras) {
    camera.position = place(camera.position);
    camera.target = place(camera.target);
    camera.up = way(camera.up);
    camera.near_plane *= factor;
    camera.orthographic_height *= factor;
  }
  for (PlanarReceiver& receiver : scene.receivers)
    for (glm::dvec3& corner : receiver.corners) corner = place(corner);
  return scene;
}

Scene broken_subject(Defect defect) {
  return assembled({}, broken_crate(defect));
}

}  // namespace penumbra::experiments::stability
