// Alpha that is the same all over a surface: solid at the cutoff and above, nothing below it.
#include <gtest/gtest.h>

#include "tests/volumes/drawing.h"
#include "tests/volumes/exact_rays.h"

namespace penumbra {
namespace alpha_test {

using test::draw;
constexpr std::uint32_t width = 96;
constexpr std::uint32_t small = 32;

struct Glass {
  float factor = 1.0f, vertex = 1.0f, cutoff = 0.5f;
  int texel = -1;  ///< alpha of every texel of a texture, or no texture
};

/// A box of masked glass over the ground, and a camera that looks through it.
Scene with_glass(const Glass& glass) {
  scenes::SceneBuilder b("glass", "A box of glass");
  const scenes::Look grey = b.look("grey", glm::vec3(0.7f));
  const scenes::Look look = b.look("glass", glm::vec3(0.5f));
  b.ground({-3.0, -3.0}, {3.0, 3.0}, grey);
  b.place(scenes::box({-0.4, 0.2, -0.3}, {0.5, 0.9, 0.4}), look, "box");
  b.spot("lamp", {1.1, 3.0, 0.7}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 60.0, LightExtent{});
  b.camera("main", {2.0, 2.6, 3.4}, {-0.2, 0.2, -0.1}, 50.0);
  Material& material = b.scene.materials[look.material];
  material.alpha_mode = AlphaMode::mask;
  material.alpha = glass.factor;
  material.alpha_cutoff = glass.cutoff;
  Mesh& mesh = b.scene.meshes.back();
  mesh.colors.assign(mesh.positions.size(), glm::vec4(1.0f, 1.0f, 1.0f, glass.vertex));
  mesh.uvs.assign(mesh.positions.size(), glm::vec2(0.3f, 0.7f));
  if (glass.texel >= 0) {
    Texture texture{"even", 4, 4, std::vector<std::uint8_t>(64, 255)};
    for (std::size_t i = 3; i < 64; i += 4)
      texture.rgba[i] = static_cast<std::uint8_t>(glass.texel);
    b.scene.textures.push_back(texture);
    material.texture = static_cast<int>(b.scene.textures.size()) - 1;
  }
  return b.scene;
}

/// Pixels that exact rays contradict.
std::size_t wrong_pixels(const RenderResult& result, const Scene& truth_of) {
  const std::vector<int> truth = test::exact_visibility(truth_of, {}, width);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    wrong += truth[i] >= 0 && result.judged.pixels[i] == 1.0f &&
             result.visibility.pixels[i] != static_cast<float>(truth[i]);
  return wrong;
}

TEST(EvenAlpha, at_the_cutoff_is_solid) {
  for (const Glass& glass :
       {Glass{0.5f}, Glass{0.25f, 1.0f, 0.25f}, Glass{1.0f, 0.5f}, Glass{0.501f},
        Glass{0.5f, 0.5f, 0.25f}, Glass{1.0f, 1.0f, 128.0f / 255.0f, 128}})
    for (const char* technique : {"ray-traced", "shadow-volumes"}) {
      const Scene scene = with_glass(glass);
      EXPECT_EQ(wrong_pixels(draw(scene, technique, {}, {}, width), scene), 0u)
          << technique << " " << glass.factor << " " << glass.vertex << " " << glass.cutoff;
    }
}

/// The darkest pixel that exact rays say is lit where the glass is not there.
float darkest_lit(const Glass& glass, const std::string& technique) {
  Scene bare = with_glass(glass);
  bare.instances.pop_back();
  const std::vector<int> truth = test::exact_visibility(bare, {}, small);
  const RenderResult result = draw(with_glass(glass), technique, {}, {}, small);
  float darkest = 1.0f;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (truth[i] == 1 && result.judged.pixels[i] == 1.0f)
      darkest = std::min(darkest, result.visibility.pixels[i]);
  return darkest;
}

TEST(EvenAlpha, below_the_cutoff_is_not_there) {
  for (const auto& technique : techniques::all()) {
    if (technique.family == "truth") continue;
    // A shadow would be dark; what filters of moments lose at the ground's edge is not.
    EXPECT_GT(darkest_lit({0.3f}, technique.id), 0.75f) << technique.id;
  }
  for (const Glass& glass :
       {Glass{1.0f, 0.49f}, Glass{0.5f, 0.5f, 0.2501f}, Glass{1.0f, 1.0f, 0.5f, 127}})
    for (const char* technique : {"ray-traced", "shadow-volumes", "shadow-map"})
      EXPECT_GT(darkest_lit(glass, technique), 0.99f) << technique;
}

TEST(EvenAlpha, at_the_cutoff_in_a_part_of_an_uneven_mesh_is_solid_there) {
  Scene scene = with_glass({});
  Mesh& mesh = scene.meshes.back();
  // One face of another alpha makes holes a question of each pixel; all are solid.
  for (std::size_t v = 0; v < mesh.colors.size(); ++v) mesh.colors[v].a = v < 4 ? 0.75f : 0.5f;
  scene.materials[mesh.primitives[0].material].alpha_cutoff = 0.5f;
  EXPECT_EQ(wrong_pixels(draw(scene, "ray-traced", {}, {}, width), scene), 0u);
}

}  // namespace alpha_test
}  // namespace penumbra
