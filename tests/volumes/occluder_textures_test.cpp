// Occluder textures: their planes and pictures against known shapes, their shadows against rays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "scenes/document.h"
#include "techniques/occluder-textures/picture.h"
#include "tests/kept_pictures/kept_pictures.h"
#include "tests/volumes/drawing.h"

namespace penumbra {
namespace occluder_textures_test {

using techniques::occluder_textures::Body;
using techniques::occluder_textures::box_around;
using techniques::occluder_textures::Picture;
using techniques::occluder_textures::Rectangle;
using test::draw;

Body body_of(const scenes::Solid& solid, const glm::dmat4& matrix = glm::dmat4(1.0)) {
  Body body;
  const scenes::Solid moved = scenes::transformed(solid, matrix);
  for (const auto& t : moved.triangles)
    body.triangles.push_back({moved.points[t[0]], moved.points[t[1]], moved.points[t[2]]});
  return body;
}

const Rectangle four_metres{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {4.0, 4.0}};

TEST(OccluderPicture, of_a_ball_is_a_disc_and_its_section_a_smaller_one) {
  const Body ball = body_of(scenes::sphere(1.0, 96, 48));
  Picture silhouette(256);
  silhouette.add_silhouette(four_metres, ball);
  EXPECT_NEAR(silhouette.filled() * 16.0, 3.14159, 0.02);
  Rectangle high = four_metres;
  high.center.z = 0.8;
  Picture section(256);
  section.add_section(high, ball);
  EXPECT_NEAR(section.filled() * 16.0, 3.14159 * (1.0 - 0.64), 0.02);
}

TEST(OccluderPicture, has_the_hole_of_a_ring_in_silhouette_and_section) {
  // A torus that lies in the plane of the picture: radii 1.2 and 0.8 in its middle plane.
  const Body ring = body_of(scenes::torus(1.0, 0.2, 96, 48),
                            glm::rotate(glm::dmat4(1.0), 1.5707963, glm::dvec3(1.0, 0.0, 0.0)));
  for (const bool section : {false, true}) {
    Picture picture(256);
    if (section)
      picture.add_section(four_metres, ring);
    else
      picture.add_silhouette(four_metres, ring);
    EXPECT_NEAR(picture.filled() * 16.0, 3.14159 * (1.44 - 0.64), 0.03);
    EXPECT_EQ(picture.texels()[128 * 256 + 128], 0);
  }
}

TEST(OccluderPicture, is_continued_only_into_bodies) {
  Picture picture(16), allowed(16);
  picture.texels()[8 * 16 + 8] = 255;
  for (std::size_t x = 0; x < 16; ++x) allowed.texels()[8 * 16 + x] = 255;
  picture.extend_within(allowed, 3);
  EXPECT_EQ(picture.filled() * 256.0, 7.0) << "three texels to each side along the row";
}

TEST(OccluderBodies, that_are_flat_and_set_at_an_angle_get_a_box_as_flat) {
  const Body plate =
      body_of(scenes::box({-1.0, -0.02, -0.7}, {1.0, 0.02, 0.7}),
              glm::rotate(glm::dmat4(1.0), 0.5, glm::normalize(glm::dvec3(1.0, 0.3, 0.2))));
  const auto box = box_around(plate, glm::dmat3(1.0));
  EXPECT_NEAR(std::min({box.half.x, box.half.y, box.half.z}), 0.02, 1e-6);
}

RenderResult rays_of(const Scene& scene) {
  return draw(scene, "ray-traced", {{"rays", std::int64_t{1}}});
}

metrics::VisibilityError error_of(const RenderResult& result, const RenderResult& truth) {
  return tests::visibility_error(result.visibility, truth.visibility, truth.judged);
}

TEST(OccluderTextures, of_a_flat_plate_are_its_shadow) {
  scenes::SceneBuilder b("plate", "A plate at an angle");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-3.0, -3.0}, {3.0, 3.0}, look);
  b.place(scenes::box({-0.6, -0.005, -0.4}, {0.6, 0.005, 0.4}), look, "plate",
          glm::translate(glm::dmat4(1.0), {0.0, 1.0, 0.0}) *
              glm::rotate(glm::dmat4(1.0), 0.4, glm::dvec3(1.0, 0.0, 0.3)));
  b.spot("lamp", {1.1, 4.0, 0.7}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 50.0, LightExtent{});
  b.camera("main", {0.0, 4.0, 3.4}, {0.0, 0.3, 0.0}, 45.0);
  const RenderResult rays = rays_of(b.scene);
  EXPECT_LT(error_of(draw(b.scene, "occluder-textures"), rays).rms, 0.03);
  EXPECT_GT(error_of(draw(b.scene, "none"), rays).rms, 0.15);
}

/// Planes that Coleman's thesis (2006, 5) gives its two models, and the textures they share.
TEST(OccluderTextures, of_the_built_in_models_are_those_of_their_source) {
  const auto textures_of = [](const Scene& scene) {
    std::set<std::string> names;
    for (const ShadowPlane& plane : scene.shadow_planes) names.insert(plane.texture);
    return names.size();
  };
  const auto named = [](const Scene& scene, const std::string& part) {
    return std::count_if(
        scene.shadow_planes.begin(), scene.shadow_planes.end(),
        [&](const ShadowPlane& plane) { return plane.name.find(part) != std::string::npos; });
  };
  const Scene jet = *scenes::load("aircraft"), pot = *scenes::load("teapot");
  EXPECT_EQ(jet.shadow_planes.size(), 3u);
  EXPECT_EQ(textures_of(jet), 2u);
  EXPECT_EQ(named(jet, "fin"), 2);
  EXPECT_EQ(named(pot, "top") + named(pot, "knob"), 3);
  EXPECT_EQ(named(pot, "body"), 3);  // none of his: they shadow the table
  EXPECT_EQ(pot.shadow_planes.size(), 3u + 3u + 5u + 3u);
  EXPECT_EQ(named(pot, "spout"), 3);
  EXPECT_EQ(named(pot, "handle"), 5);
  for (const ShadowPlane& plane : pot.shadow_planes)
    EXPECT_EQ(plane.texture == "dark", plane.name.starts_with("handle")) << plane.name;
}

TEST(OccluderTextures, that_were_authored_suit_the_aircraft) {
  const Scene scene = *scenes::load("aircraft");
  const RenderResult rays = rays_of(scene);
  const RenderResult result = draw(scene, "occluder-textures");
  EXPECT_THAT(result.notes, testing::Contains(testing::StartsWith("3 planes of the scene")));
  const auto none = error_of(draw(scene, "none"), rays);
  const auto own = error_of(result, rays);
  EXPECT_LT(own.missing_shadow, 0.35 * none.missing_shadow);
  EXPECT_LT(own.false_shadow, 0.02);
}

TEST(OccluderTextures, that_were_authored_shadow_the_table_as_generated_ones_do) {
  const Scene scene = *scenes::load("teapot");
  const RenderResult rays = rays_of(scene);
  const auto none = error_of(draw(scene, "none"), rays);
  const auto own = error_of(draw(scene, "occluder-textures"), rays);
  EXPECT_LT(own.missing_shadow, 0.8 * none.missing_shadow);
  EXPECT_LT(own.false_shadow, 0.02);
}

TEST(OccluderTextures, that_are_generated_suit_the_aircraft_and_not_the_teapot) {
  for (const char* id : {"aircraft", "teapot"}) {
    const Scene scene = *scenes::load(id);
    const RenderResult rays = rays_of(scene);
    const auto none = error_of(draw(scene, "none"), rays);
    const auto own =
        error_of(draw(scene, "occluder-textures", {{"source", std::string("generated")}}), rays);
    const bool aircraft = std::string(id) == "aircraft";
    EXPECT_LT(own.missing_shadow, (aircraft ? 0.35 : 0.8) * none.missing_shadow) << id;
    if (aircraft) continue;
    EXPECT_GT(own.missing_shadow, 0.05 * none.missing_shadow) << "pieces are missing";
  }
}

TEST(OccluderTextures, cast_false_shadows_without_the_sign_test) {
  const Scene scene = *scenes::load("aircraft");
  const RenderResult rays = rays_of(scene);
  const double with = error_of(draw(scene, "occluder-textures"), rays).false_shadow;
  const double without =
      error_of(draw(scene, "occluder-textures", {{"sign_test", false}}), rays).false_shadow;
  EXPECT_GT(without, 2.0 * with + 0.01);
}

/// A plate 1 m above the ground, and a plane that replaces it but shadows only where z < 0.
constexpr const char* document = R"({
  "penumbra_scene": 1, "title": "Authored",
  "materials": [{"name": "grey", "base_color": [0.7, 0.7, 0.7]}],
  "meshes": [
    {"name": "slab", "generator": "box", "low": [-3, -0.2, -3], "high": [3, 0, 3], "material": "grey"},
    {"name": "plate", "generator": "box", "low": [-0.5, 1, -0.5], "high": [0.5, 1.02, 0.5], "material": "grey"}],
  "instances": [{"mesh": "slab", "name": "slab"}, {"mesh": "plate", "name": "plate"}],
  "lights": [{"name": "lamp", "position": [0, 4, 0], "target": [0, 0, 0], "outer_angle": 50}],
  "cameras": [{"name": "main", "position": [0, 0.9, 2.6], "target": [0, 0, 0], "vertical_fov": 50}],
  "shadow_planes": [
    {"name": "plate", "center": [0, 1.01, 0], "right": [1, 0, 0], "up": [0, 0, -1], "size": [1.1, 1.1],
     "casters": ["plate"], "receivers": {"low": [-3, -1, -3], "high": [3, 0.5, 0]}}]
})";

TEST(OccluderTextures, may_be_authored_in_the_scene_for_a_box_of_receivers) {
  Scene scene = scenes::read_document(nlohmann::json::parse(document), ".");
  ASSERT_EQ(scene.shadow_planes.size(), 1u);
  const RenderResult result = draw(scene, "occluder-textures");
  EXPECT_THAT(result.notes,
              testing::Contains(testing::HasSubstr("1 planes of the scene stand for 1 of 2")));
  int dark = 0, wrong = 0;
  for (std::uint32_t y = 0; y < test::size; ++y)
    for (std::uint32_t x = 0; x < test::size; ++x) {
      const glm::dvec3 p = test::ground_point(scene.cameras[0], x, y);
      if (result.judged.at(x, y, 0) < 1.0f || std::abs(p.x) > 2.5 || std::abs(p.z) > 2.5) continue;
      // Thrown from 4 m over 1.01 m, half a metre becomes 0.669 m.
      const double outside = std::max(std::abs(p.x), std::abs(p.z)) - 0.5 * 4.0 / 2.99;
      if (std::abs(outside) < 0.02 || std::abs(p.z) < 0.01) continue;
      const bool shadow = outside < 0.0 && p.z < 0.0;
      dark += shadow;
      wrong += (result.visibility.at(x, y, 0) < 0.5f) != shadow;
    }
  EXPECT_GT(dark, 300);
  EXPECT_EQ(wrong, 0);
  // Where the author's planes are set aside, generated ones shadow the other half as well.
  const RenderResult generated =
      draw(scene, "occluder-textures", {{"source", std::string("generated")}});
  EXPECT_NE(generated.visibility.pixels, result.visibility.pixels);
}

TEST(OccluderTextures, take_dark_texels_of_an_authored_texture_as_casters) {
  Scene scene = scenes::read_document(nlohmann::json::parse(document), ".");
  // The left half of the texture is black, the right half white.
  scene.textures.push_back({"halves", 2, 1, {0, 0, 0, 255, 255, 255, 255, 255}});
  scene.shadow_planes[0].texture = "halves";
  scene.shadow_planes[0].receivers = {};
  const RenderResult result = draw(scene, "occluder-textures", {{"bilinear", false}});
  int dark[2] = {0, 0};
  for (std::uint32_t y = 0; y < test::size; ++y)
    for (std::uint32_t x = 0; x < test::size; ++x)
      if (result.judged.at(x, y, 0) == 1.0f && result.visibility.at(x, y, 0) < 0.5f)
        ++dark[test::ground_point(scene.cameras[0], x, y).x > 0.01 ? 1 : 0];
  EXPECT_GT(dark[0], 300);
  EXPECT_EQ(dark[1], 0);
}

TEST(OccluderTextures, of_the_scene_survive_writing_and_reading_and_change_its_hash) {
  Scene scene = scenes::read_document(nlohmann::json::parse(document), ".");
  const Scene again = scenes::read_document(scenes::write_document(scene), ".");
  ASSERT_EQ(again.shadow_planes.size(), 1u);
  EXPECT_EQ(again.shadow_planes[0].center, scene.shadow_planes[0].center);
  EXPECT_EQ(again.shadow_planes[0].casters, scene.shadow_planes[0].casters);
  EXPECT_EQ(again.shadow_planes[0].receivers.high, scene.shadow_planes[0].receivers.high);
  EXPECT_EQ(scenes::content_hash(again), scenes::content_hash(scene));
  scene.shadow_planes[0].size.x *= 2.0;
  EXPECT_NE(scenes::content_hash(again), scenes::content_hash(scene));
}

/// Ground, lamp and camera around what hangs a metre over the ground.
scenes::SceneBuilder stage() {
  scenes::SceneBuilder b("sheets", "Sheets");
  b.ground({-3.0, -3.0}, {3.0, 3.0}, b.look("grey", glm::vec3(0.7f)));
  b.spot("lamp", {1.1, 4.0, 0.7}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 50.0, LightExtent{});
  b.camera("main", {0.0, 4.0, 3.4}, {0.0, 0.3, 0.0}, 45.0);
  return b;
}

/// A card of 1.4 m by 0.8 m, its back as well where `doubled`.
scenes::Solid card(bool doubled) {
  scenes::Solid solid;
  for (const glm::dvec2 corner : {glm::dvec2(-0.7, -0.4), {0.7, -0.4}, {0.7, 0.4}, {-0.7, 0.4}})
    solid.add_point({corner.x, 0.0, corner.y});
  solid.add_quad(3, 2, 1, 0);
  if (doubled) solid.add_quad(0, 1, 2, 3);
  return solid;
}

/// A wall around the y axis, open above and below.
scenes::Solid shade(int sides) {
  scenes::Solid solid;
  for (int i = 0; i < sides; ++i) {
    const double angle = 6.283185307179586 * i / sides;
    const glm::dvec2 out(std::cos(angle), std::sin(angle));
    solid.add_point({0.5 * out.x, 0.0, 0.5 * out.y});
    solid.add_point({0.3 * out.x, 0.4, 0.3 * out.y});
  }
  for (int i = 0; i < sides; ++i) {
    const auto a = static_cast<std::uint32_t>(2 * i);
    const auto b = static_cast<std::uint32_t>(2 * ((i + 1) % sides));
    solid.add_quad(a, a + 1, b + 1, b);
  }
  return solid;
}

void make_double_sided(Scene& scene) {
  for (Material& material : scene.materials) material.double_sided = true;
}

TEST(OccluderTextures, of_flat_cards_are_their_shadows_however_they_are_turned) {
  for (const bool doubled : {false, true})
    for (int turn = 0; turn < 8; ++turn) {
      scenes::SceneBuilder b = stage();
      const glm::dvec3 axis =
          glm::normalize(glm::dvec3(std::sin(1.0 + 3.0 * turn), 0.3, std::cos(2.0 * turn)));
      b.place(card(doubled), b.look("red", glm::vec3(0.5f)), "card",
              glm::translate(glm::dmat4(1.0), {0.0, 1.0, 0.0}) *
                  glm::rotate(glm::dmat4(1.0), turn == 0 ? 0.0 : 0.7, axis));
      make_double_sided(b.scene);
      const RenderResult rays = rays_of(b.scene);
      EXPECT_GT(error_of(draw(b.scene, "none"), rays).rms, 0.1);
      EXPECT_LT(error_of(draw(b.scene, "occluder-textures"), rays).rms, 0.04)
          << "turn " << turn << " doubled " << doubled;
    }
}

TEST(OccluderTextures, of_open_shades_and_crates_are_those_of_their_sides) {
  for (const int sides : {4, 7, 16})
    for (const bool lamp_inside : {false, true}) {
      scenes::SceneBuilder b = stage();
      b.place(shade(sides), b.look("red", glm::vec3(0.5f)), "shade",
              glm::translate(glm::dmat4(1.0), {0.0, 1.0, 0.0}));
      make_double_sided(b.scene);
      Light& lamp = b.scene.lights[0];
      if (lamp_inside) {
        lamp.kind = LightKind::point;
        lamp.position = {0.0, 1.2, 0.0};
      }
      const RenderResult rays = rays_of(b.scene);
      const auto none = error_of(draw(b.scene, "none"), rays);
      const auto own = error_of(draw(b.scene, "occluder-textures"), rays);
      EXPECT_GT(none.rms, 0.1);
      EXPECT_LT(own.rms, 0.25 * none.rms) << sides << " sides, lamp inside " << lamp_inside;
    }
}

TEST(OccluderTextures, say_that_a_round_sheet_has_too_many_parts) {
  scenes::Solid half = scenes::sphere(0.5, 64, 32);
  std::erase_if(half.triangles, [&](const auto& t) { return half.points[t[0]].y < 0.0; });
  scenes::SceneBuilder b = stage();
  b.place(half, b.look("red", glm::vec3(0.5f)), "bowl",
          glm::translate(glm::dmat4(1.0), {0.0, 1.0, 0.0}));
  EXPECT_THAT(draw(b.scene, "occluder-textures", {{"planes", std::int64_t{4}}}).notes,
              testing::Contains(testing::HasSubstr("too many flat parts")));
}

}  // namespace occluder_textures_test
}  // namespace penumbra
