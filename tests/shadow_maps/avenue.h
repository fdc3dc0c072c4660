#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "renderer/shadow_maps/layout.h"
#include "scenes.h"
#include "techniques/layout_matrix.h"

/// What a person sees who looks along a plain, under a sun: scenes that layouts are judged by.
namespace penumbra::tests {

/// Ground of 80 m, from 120 m before a person who looks along it to z = `behind`.
inline Scene plain(const glm::dvec3& eye = {0, 2, 5}, const glm::dvec3& target = {0, 1, -20},
                   double behind = 10.0) {
  Scene scene = empty_scene(2.0, 1.0);
  add_plate(scene, {-40, -120}, {40, behind}, 0.0);
  Camera& camera = scene.cameras[0];
  camera.position = eye;
  camera.target = target;
  camera.up = {0, 1, 0};
  camera.projection = Projection::perspective;
  camera.vertical_fov = 50.0;
  camera.near_plane = 0.1;
  return scene;
}

inline Light slanted_sun(const glm::dvec3& direction) {
  Light light = sun();
  light.direction = glm::normalize(direction);
  return light;
}

/// Posts along both sides of the way, under a low sun.
inline Scene avenue() {
  Scene scene = plain();
  for (const double z : {-1.0, -4.0, -8.0, -14.0, -22.0, -34.0, -50.0, -75.0})
    for (const double x : {-2.5, 2.0})
      add_box(scene, {x - 0.5, 0.001, z - 0.5}, {x + 0.5, 4.0, z + 0.5});
  scene.lights.push_back(slanted_sun({0.7, -1.0, -0.3}));
  return scene;
}

inline std::vector<std::string> layout_ids() {
  std::vector<std::string> ids;
  for (const shadow_maps::Layout& layout : shadow_maps::layouts()) ids.push_back(layout.id);
  return ids;
}

/// Layouts that serve a sun.
inline std::vector<std::string> sun_layouts() {
  return shadow_maps::layouts_for(LightKind::directional);
}

/// Whether a technique draws a sun with a layout.
inline bool draws_sun(const std::string& technique, const std::string& layout) {
  for (const techniques::LayoutRow& row : techniques::layout_matrix())
    if (row.technique == technique)
      return std::count(row.lights.at(layout).begin(), row.lights.at(layout).end(), "directional") >
             0;
  return true;  // a preset of one that serves all
}

}  // namespace penumbra::tests
