// What a light says of itself, against the definitions of cones, boxes and rays.
#include "renderer/scene/light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>
#include <set>

namespace penumbra {
namespace {

/// Lights of every kind and extent, askew.
std::vector<Light> all_lights() {
  std::vector<Light> lights;
  for (const auto& [kind_name, kind] : light_kinds())
    for (const auto& [extent_name, extent] : extent_kinds()) {
      Light light;
      light.name = std::string(kind_name) + ", " + extent_name;
      light.kind = kind;
      light.extent = {extent, 0.7, glm::dvec2(1.2, 0.4)};
      light.position = {1.0, 4.0, -2.0};
      light.direction = glm::normalize(glm::dvec3(0.3, -0.8, 0.4));
      light.outer_angle = 35.0;
      light.inner_angle = 20.0;
      lights.push_back(light);
    }
  return lights;
}

class Random {
 public:
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  glm::dvec3 point(double reach) {
    return {number(-reach, reach), number(-reach, reach), number(-reach, reach)};
  }

 private:
  std::mt19937_64 generator_{7};
};

TEST(Light, every_kind_has_a_name_of_its_own) {
  std::set<std::string> names;
  for (const auto& [name, kind] : light_kinds()) {
    EXPECT_EQ(name_of(kind), name);
    names.insert(name);
  }
  EXPECT_EQ(names, (std::set<std::string>{"spot", "directional", "point"}));
}

TEST(Light, its_ray_through_a_point_leads_away_from_its_centre) {
  Random random;
  const glm::dvec3 origin(3.0, -1.0, 2.0);
  for (const Light& light : all_lights()) {
    const WorldLight world = world_light(light, origin);
    for (int i = 0; i < 20; ++i) {
      const glm::dvec3 point = random.point(9.0);
      const glm::dvec3 away = light.kind == LightKind::directional
                                  ? light.direction
                                  : glm::normalize(point - (light.position - origin));
      EXPECT_LT(glm::length(world.ray_direction(point) - away), 1e-12) << light.name;
      EXPECT_LT(glm::length(glm::normalize(world.to_center(point)) + away), 1e-12) << light.name;
    }
  }
}

TEST(Light, points_fill_the_box_and_the_ball_around_its_extent) {
  Random random;
  for (const Light& light : all_lights()) {
    const glm::dvec3 half = extent_half_size(light);
    const double radius = extent_radius(light);
    glm::dvec3 most(0.0);
    double farthest = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const glm::dvec3 offset = extent_offset(light, 0.5 + random.point(0.5));
      most = glm::max(most, glm::abs(offset));
      farthest = std::max(farthest, glm::length(offset));
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(most[axis], half[axis]) << light.name;
      EXPECT_GE(most[axis], 0.95 * half[axis]) << light.name;
    }
    EXPECT_LE(farthest, radius * (1.0 + 1e-12)) << light.name;
    EXPECT_GE(farthest, 0.95 * radius) << light.name;
    EXPECT_EQ(has_extent(light), radius > 0.0) << light.name;
  }
}

TEST(Light, at_infinity_its_extent_is_seen_under_the_angle_that_it_names) {
  Light sun;
  sun.kind = LightKind::directional;
  sun.direction = {0.0, -1.0, 0.0};
  sun.extent = {ExtentKind::disc, 2.5, glm::dvec2(0.0)};
  const WorldLight world = world_light(sun, glm::dvec3(0.0));
  const glm::dvec3 border = world.extent_point({extent_radius(sun), 0.0, 0.0});
  EXPECT_NEAR(glm::degrees(std::acos(border.y)), 2.5, 1e-9);
}

TEST(Light, a_ball_with_a_lit_point_is_reached_and_one_behind_a_spot_is_not) {
  Random random;
  int reached = 0, missed = 0;
  for (Light light : all_lights()) {
    light.range = 6.0;
    const WorldLight world = world_light(light, glm::dvec3(0.0));
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 middle = light.position + random.point(8.0);
      const double radius = random.number(0.1, 2.0);
      const glm::dvec3 point = middle + radius * 0.57 * random.point(1.0);  // within the ball
      const glm::dvec3 offset = point - light.position;
      const double angle = std::acos(glm::dot(glm::normalize(offset), light.direction));
      const bool lit = light.kind == LightKind::directional ||
                       (glm::length(offset) <= 6.0 && (light.kind == LightKind::point ||
                                                       angle <= glm::radians(light.outer_angle)));
      if (lit) {
        EXPECT_TRUE(world.may_reach(middle, radius)) << light.name;
      }
      (world.may_reach(middle, radius) ? reached : missed) += 1;
    }
    const bool behind = world.may_reach(light.position - 3.0 * light.direction, 0.5);
    EXPECT_EQ(behind, light.kind != LightKind::spot) << light.name;
    const bool beyond = world.may_reach(light.position + 9.0 * light.direction, 0.5);
    EXPECT_EQ(beyond, light.kind == LightKind::directional) << light.name;
  }
  EXPECT_GT(reached, 500);
  EXPECT_GT(missed, 500);
}

TEST(Light, a_spot_fades_from_its_inner_to_its_outer_angle_and_with_the_square_of_distance) {
  for (Light light : all_lights()) {
    light.attenuation = Attenuation::inverse_square;
    light.range = 5.0;
    const glm::dvec3 side = world_light(light, glm::dvec3(0.0)).right;
    const auto at = [&](double cosine) {
      return cone_strength(light,
                           -cosine * light.direction + std::sqrt(1.0 - cosine * cosine) * side);
    };
    const bool spot = light.kind == LightKind::spot;
    const double inner = std::cos(glm::radians(20.0)), outer = std::cos(glm::radians(35.0));
    EXPECT_NEAR(at(inner), 1.0, 1e-9) << light.name;
    EXPECT_NEAR(at(0.5 * (inner + outer)), spot ? 0.5 : 1.0, 1e-9) << light.name;
    EXPECT_NEAR(at(outer), spot ? 0.0 : 1.0, 1e-9) << light.name;
    const bool directional = light.kind == LightKind::directional;
    EXPECT_DOUBLE_EQ(attenuation_at(light, 2.0), directional ? 1.0 : 0.25) << light.name;
    EXPECT_DOUBLE_EQ(attenuation_at(light, 5.1), directional ? 1.0 : 0.0) << light.name;
  }
}

}  // namespace
}  // namespace penumbra
