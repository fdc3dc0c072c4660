// Lights and casters that are hard to serve: the right shadow by exact rays, or a note.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/volumes/drawing.h"
#include "tests/volumes/exact_rays.h"

namespace penumbra {
namespace served_casters_test {

using test::draw;
using testing::Contains;
using testing::HasSubstr;
constexpr std::uint32_t width = 96;

/// Ground, lamp and camera, without a caster.
scenes::SceneBuilder stage() {
  scenes::SceneBuilder b("stage", "A ground");
  b.ground({-6.0, -6.0}, {6.0, 6.0}, b.look("grey", glm::vec3(0.7f)));
  b.spot("lamp", {-2.0, 4.0, 2.5}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 40.0, {});
  b.camera("main", {2.5, 3.0, 5.0}, {0.0, 0.5, 0.0}, 40.0);
  return b;
}

Scene with_box() {
  scenes::SceneBuilder b = stage();
  b.place(scenes::box({-0.5, 0.3, -0.5}, {0.5, 1.3, 0.5}), b.look("red", glm::vec3(0.5f)), "box");
  return b.scene;
}

/// A level card over the ground that looks up or down.
Scene with_card(bool up, bool double_sided) {
  scenes::SceneBuilder b = stage();
  Material material;
  material.double_sided = double_sided;
  b.scene.materials.push_back(material);
  Mesh mesh;
  for (const glm::vec2 corner :
       {glm::vec2(-0.7f, -0.7f), {-0.7f, 0.7f}, {0.7f, 0.7f}, {0.7f, -0.7f}}) {
    mesh.positions.push_back({corner.x, 1.0f, corner.y});
    mesh.normals.push_back({0.0f, up ? 1.0f : -1.0f, 0.0f});
    mesh.uvs.push_back(corner);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  if (!up) mesh.indices = {0, 2, 1, 0, 3, 2};
  mesh.primitives.push_back({0, 6, static_cast<std::uint32_t>(b.scene.materials.size() - 1)});
  b.place(b.add_mesh("card", mesh), glm::dmat4(1.0), "card");
  return b.scene;
}

/// The box with every triangle once more, wound the other way.
Scene with_doubled_box() {
  Scene scene = with_box();
  Mesh& mesh = scene.meshes.back();
  const std::vector<std::uint32_t> once = mesh.indices;
  for (std::size_t i = 0; i + 2 < once.size(); i += 3)
    mesh.indices.insert(mesh.indices.end(), {once[i], once[i + 2], once[i + 1]});
  mesh.primitives.front().index_count *= 2;
  return scene;
}

struct Judged {
  double wrong = 0.0;  ///< share of the pixels that face the light
  double dark = 0.0;
  std::vector<std::string> notes;
};

/// `surfaces` are what exact rays meet: the scene's, or the same ones without doubles, in whose
/// plane a ray would start.
Judged judge(const Scene& scene, const std::string& technique,
             const ParameterValues& parameters = {}, const Scene* surfaces = nullptr) {
  const RenderResult result = draw(scene, technique, parameters, {}, width);
  const std::vector<int> truth =
      test::exact_visibility(surfaces != nullptr ? *surfaces : scene, {}, width);
  Judged judged;
  double count = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] < 0 || result.judged.pixels[i] < 1.0f) continue;
    ++count;
    judged.dark += truth[i] == 0;
    judged.wrong += std::abs(result.visibility.pixels[i] - static_cast<float>(truth[i])) > 0.5f;
  }
  judged.dark /= count;
  judged.wrong /= count;
  judged.notes = result.notes;
  return judged;
}

TEST(WideSpots, cast_their_shadows_in_every_technique_of_maps) {
  for (const double angle : {76.0, 85.0, 89.0, 89.9}) {
    Scene scene = with_box();
    scene.lights[0].inner_angle = scene.lights[0].outer_angle = angle;
    for (const char* technique : {"shadow-map", "pcf-3x3", "pcss", "vsm", "esm", "evsm", "msm",
                                  "savsm", "hybrid", "shadow-volumes", "ray-traced"}) {
      const Judged judged = judge(scene, technique);
      EXPECT_GT(judged.dark, 0.03);
      EXPECT_LT(judged.wrong, 0.25 * judged.dark) << technique << " at " << angle;
    }
  }
}

TEST(DoubledFaces, are_exact_in_volumes) {
  const Scene scene = with_doubled_box(), once = with_box();
  for (const char* technique :
       {"shadow-volumes", "shadow-volumes-zpass", "shadow-volumes-zpass-plus", "hybrid"})
    EXPECT_LE(judge(scene, technique, {}, &once).wrong,
              technique == std::string("hybrid") ? 0.02 : 0.0)
        << technique;
}

TEST(Volumes, leave_a_face_lit_whose_lamp_lies_in_the_plane_of_a_sheet) {
  for (const double height : {0.0, 0.3}) {
    scenes::SceneBuilder b = stage();
    Mesh plane;
    for (const glm::vec2 corner : {glm::vec2(-5, -5), {-5, 5}, {5, 5}, {5, -5}}) {
      plane.positions.push_back({corner.x, static_cast<float>(height), corner.y});
      plane.normals.push_back({0.0f, 1.0f, 0.0f});
    }
    plane.indices = {0, 1, 2, 0, 2, 3};
    plane.primitives.push_back({0, 6, 0});
    b.place(b.add_mesh("sheet", plane), glm::dmat4(1.0), "sheet");
    b.place(scenes::box({-0.9, height, -0.5}, {-0.4, height + 1.0, 0.5}),
            b.look("red", glm::vec3(0.5f)), "box");
    Light& lamp = b.scene.lights[0];
    lamp.kind = LightKind::point;
    lamp.position = {0.0, static_cast<double>(static_cast<float>(height)), 0.0};
    for (const char* technique :
         {"shadow-volumes", "shadow-volumes-zpass", "shadow-volumes-zpass-plus"})
      EXPECT_EQ(judge(b.scene, technique).wrong, 0.0) << technique << " at " << height;
  }
}

TEST(Sheets, are_exact_in_volumes_that_find_silhouettes_whichever_way_they_look) {
  for (const bool up : {true, false})
    for (const char* technique :
         {"shadow-volumes", "shadow-volumes-zpass", "shadow-volumes-zpass-plus"})
      EXPECT_EQ(judge(with_card(up, true), technique).wrong, 0.0) << technique << " up " << up;
}

TEST(Sheets, throw_no_second_shadow_where_the_camera_looks_through_them) {
  // Single-sided, seen from behind: the camera sees the ground through the card.
  const Scene scene = with_card(false, false);
  const RenderResult traced = draw(scene, "ray-traced", {}, {}, width);
  for (const char* technique : {"shadow-volumes-zpass", "shadow-volumes-zpass-plus"}) {
    const RenderResult result = draw(scene, technique, {}, {}, width);
    std::size_t different = 0;
    for (std::size_t i = 0; i < traced.visibility.pixels.size(); ++i)
      different += traced.judged.pixels[i] == 1.0f &&
                   result.visibility.pixels[i] != traced.visibility.pixels[i];
    EXPECT_LE(different, 12u) << technique << ": edges only";
  }
}

TEST(Notes, say_what_volumes_by_brute_force_and_second_surfaces_do_not_serve) {
  const Scene card = with_card(false, true);
  EXPECT_THAT(judge(card, "shadow-volumes-brute-force").notes, Contains(HasSubstr("open edges")));
  for (const char* strategy : {"back-faces", "second-depth", "midpoint", "dual-depth"})
    EXPECT_THAT(judge(card, "shadow-map", {{"bias_strategy", std::string(strategy)}}).notes,
                Contains(HasSubstr(strategy)));
  EXPECT_THAT(judge(with_box(), "shadow-volumes-brute-force").notes,
              testing::Not(Contains(HasSubstr("open edges"))));
  EXPECT_THAT(judge(with_box(), "shadow-map", {{"bias_strategy", std::string("midpoint")}}).notes,
              testing::Not(Contains(HasSubstr("midpoint"))));
}

TEST(Notes, say_that_masks_are_ignored) {
  Scene scene = with_card(true, true);
  Texture holes{"holes", 2, 2, std::vector<std::uint8_t>(16, 255)};
  holes.rgba[3] = 0;
  scene.textures.push_back(holes);
  scene.materials.back().texture = static_cast<int>(scene.textures.size()) - 1;
  scene.materials.back().alpha_mode = AlphaMode::mask;
  for (const char* technique : {"shadow-volumes", "shadow-volumes-brute-force",
                                "shadow-volumes-zpass", "hybrid", "occluder-textures"})
    EXPECT_THAT(judge(scene, technique).notes, Contains(HasSubstr("alpha masks"))) << technique;
}

}  // namespace served_casters_test
}  // namespace penumbra
