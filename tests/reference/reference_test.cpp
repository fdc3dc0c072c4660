#include <gtest/gtest.h>

#include <cmath>

#include "renderer/error.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra {
namespace {

class ReferencePicture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { renderer_ = new Renderer({"", true}); }
  static void TearDownTestSuite() {
    delete renderer_;
    renderer_ = nullptr;
  }

  static RenderRequest request(const std::string& scene, const std::string& technique,
                               const ParameterValues& parameters = {}) {
    return request(scenes::load(scene), technique, parameters);
  }
  static RenderRequest request(std::shared_ptr<const Scene> scene, const std::string& technique,
                               const ParameterValues& parameters = {}) {
    const auto resolved = techniques::resolve(technique, parameters);
    RenderRequest made;
    made.scene = std::move(scene);
    made.technique = resolved.technique;
    made.parameters = resolved.parameters;
    made.width = made.height = 64;
    made.light_samples = 64;
    made.visibility = true;
    return made;
  }
  static RenderResult render(const RenderRequest& wanted) { return renderer_->render(wanted); }

  static inline Renderer* renderer_ = nullptr;
};

/// Share of a square light, 1 m wide and 4 m above the plane, that is seen from x behind the plate
/// that fills x < 0 between the heights 0.9995 and 1.0005 m. A point u of the light is seen where
/// the segment passes both edges: u > x (1 - 4 / h).
double half_plane_visibility(double x) {
  const double threshold = std::max(x * (1.0 - 4.0 / 0.9995), x * (1.0 - 4.0 / 1.0005));
  return std::clamp(0.5 - threshold, 0.0, 1.0);
}

TEST_F(ReferencePicture, ShowsTheClosedFormPenumbraOfAnEdge) {
  RenderRequest wanted = request("half-plane", "reference");
  wanted.light_samples = 1024;
  const RenderResult result = render(wanted);
  // The camera looks straight down from 0.8 m with 60 degrees: picture x is world x.
  const double half = 0.8 * std::tan(std::acos(-1.0) / 6.0);
  double worst = 0.0, sum = 0.0;
  std::size_t partly = 0;
  for (std::uint32_t y = 0; y < wanted.height; ++y)
    for (std::uint32_t x = 0; x < wanted.width; ++x) {
      const double truth = half_plane_visibility(half * (2.0 * (x + 0.5) / wanted.width - 1.0));
      const double error = result.visibility.at(x, y, 0) - truth;
      worst = std::max(worst, std::abs(error));
      sum += error;
      partly += truth > 0.0 && truth < 1.0;
    }
  EXPECT_GT(partly, 500u);
  // Each of 16 scrambles has a point in every 64th of the light's width: its share errs by the
  // difference of two uniform numbers over 64, with a standard deviation of 1/(64 sqrt 6), and the
  // mean of all by a quarter of that. Five of these.
  EXPECT_LT(worst, 5.0 / (64.0 * std::sqrt(6.0) * 4.0));
  EXPECT_LT(std::abs(sum / (wanted.width * wanted.height)), 0.001);
}

TEST_F(ReferencePicture, ErrsLessThanRandomPointsDo) {
  RenderRequest wanted = request("half-plane", "reference", {{"sampling", "random"}});
  wanted.light_samples = 1024;
  const double half = 0.8 * std::tan(std::acos(-1.0) / 6.0);
  const RenderResult result = render(wanted);
  double worst = 0.0;
  for (std::uint32_t x = 0; x < wanted.width; ++x) {
    const double truth = half_plane_visibility(half * (2.0 * (x + 0.5) / wanted.width - 1.0));
    worst = std::max(worst, std::abs(result.visibility.at(x, 32, 0) - truth));
  }
  // A binomial share of 1024 has a standard deviation of at most 1/64: five of them bound it, and
  // a 64th of one would be too good for chance.
  EXPECT_LT(worst, 5.0 / 64.0);
  EXPECT_GT(worst, 0.001);
}

TEST_F(ReferencePicture, OfALightWithoutExtentIsThatOfOneRay) {
  Scene scene = *scenes::load("boxes");
  for (Light& light : scene.lights) light.extent = {};
  const auto hard = std::make_shared<const Scene>(scene);
  const RenderResult reference = render(request(hard, "reference"));
  const RenderResult traced = render(request(hard, "ray-traced"));
  EXPECT_TRUE(tests::same(reference.picture, traced.picture));
  EXPECT_TRUE(tests::same(reference.visibility, traced.visibility));
  for (const float visibility : traced.visibility.pixels)
    EXPECT_TRUE(visibility == 0.0f || visibility == 1.0f);
}

TEST_F(ReferencePicture, IsTheSameForTheSameSeedAndOnlyForIt) {
  RenderRequest wanted = request("boxes", "reference");
  wanted.linear = true;
  const RenderResult first = render(wanted);
  const RenderResult second = render(wanted);
  EXPECT_TRUE(tests::same(first.linear, second.linear));
  wanted.seed = 2;
  EXPECT_NE(first.linear.pixels, render(wanted).linear.pixels);
}

TEST_F(ReferencePicture, ConvergesToOnePictureHoweverPointsAreChosen) {
  RenderRequest wanted = request("boxes", "reference");
  wanted.light_samples = 1024;
  const RenderResult even = render(wanted);
  wanted.parameters["sampling"] = std::string("random");
  const RenderResult random = render(wanted);
  // Random points: a standard deviation of at most 1/64 in penumbrae, which fill a part only.
  EXPECT_LT(tests::visibility_error(random.visibility, even.visibility, even.judged).rms, 0.01);
  EXPECT_LT(tests::rms_y(random.picture, even.picture), 1.0);
}

TEST_F(ReferencePicture, SharesPointsAmongTheSamplesOfAPixel) {
  RenderRequest wanted = request("half-plane", "reference");
  wanted.light_samples = 256;
  const RenderResult coarse = render(wanted);
  wanted.supersampling = 4;
  const RenderResult fine = render(wanted);
  const auto error = tests::visibility_error(fine.visibility, coarse.visibility, coarse.judged);
  EXPECT_LT(error.rms, 0.01);
}

TEST_F(ReferencePicture, LightsFromTheCentreInVisibilityModeOnly) {
  const RenderResult shaded = render(request("boxes", "reference"));
  const RenderResult visibility = render(request("boxes", "reference", {{"mode", "visibility"}}));
  EXPECT_TRUE(tests::same(shaded.visibility, visibility.visibility));
  EXPECT_NE(shaded.picture.pixels, visibility.picture.pixels);
  EXPECT_LT(tests::rms_y(shaded.picture, visibility.picture), 4.0);
}

TEST_F(ReferencePicture, LetsNoLightIntoAClosedRoom) {
  RenderRequest wanted = request("leaky-box", "reference");
  wanted.width = wanted.height = 128;
  const RenderResult result = render(wanted);
  std::size_t judged = 0, lit = 0;
  for (std::size_t i = 0; i < result.visibility.pixels.size(); ++i) {
    if (result.judged.pixels[i] == 0.0f) continue;
    ++judged;
    lit += result.visibility.pixels[i] > 0.0f;
  }
  EXPECT_GT(judged, 1000u);
  EXPECT_EQ(lit, 0u);
}

TEST_F(ReferencePicture, TakesAsManyPointsAsAreAllowed) {
  RenderRequest wanted = request("half-plane", "reference");
  wanted.width = wanted.height = 4;
  wanted.light_samples = RenderLimits::max_light_samples;
  const RenderResult result = render(wanted);
  const double half = 0.8 * std::tan(std::acos(-1.0) / 6.0);
  for (std::uint32_t x = 0; x < 4; ++x)
    EXPECT_NEAR(result.visibility.at(x, 1, 0),
                half_plane_visibility(half * (2.0 * (x + 0.5) / 4.0 - 1.0)), 0.0015);
}

/// A horizontal plate, a metre above the ground, of which the texture leaves the half x > 0 open.
std::shared_ptr<const Scene> half_open_plate(float cutoff) {
  Scene scene = *scenes::load("half-plane");
  Texture texture{"stripes", 64, 1, {}};
  for (std::uint32_t x = 0; x < texture.width; ++x)
    for (int c = 0; c < 4; ++c)
      texture.rgba.push_back(c < 3 || x < texture.width / 2 ? std::uint8_t{255} : std::uint8_t{0});
  scene.textures.push_back(texture);
  Material material;
  material.name = "half open";
  material.texture = static_cast<int>(scene.textures.size()) - 1;
  material.alpha_mode = AlphaMode::mask;
  material.alpha_cutoff = cutoff;
  material.double_sided = true;
  scene.materials.push_back(material);
  Mesh mesh;
  mesh.name = "plate";
  for (const double z : {-5.0, 5.0})
    for (const double x : {-4.0, 4.0}) {
      mesh.positions.emplace_back(x, 1.0, z);
      mesh.normals.emplace_back(0.0f, 1.0f, 0.0f);
      mesh.uvs.emplace_back(x < 0.0 ? 0.0f : 1.0f, 0.5f);
    }
  mesh.indices = {0, 2, 1, 1, 2, 3};
  mesh.primitives = {{0, 6, static_cast<std::uint32_t>(scene.materials.size()) - 1}};
  for (Instance& instance : scene.instances)
    if (instance.name == "edge") {
      instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
      instance.world_from_object = glm::dmat4(1.0);
    }
  scene.meshes.push_back(mesh);
  return std::make_shared<const Scene>(scene);
}

TEST_F(ReferencePicture, LetsLightThroughHolesOfMaskedCasters) {
  RenderRequest wanted = request(half_open_plate(0.5f), "reference");
  wanted.light_samples = 1024;
  const RenderResult result = render(wanted);
  const double half = 0.8 * std::tan(std::acos(-1.0) / 6.0);
  double worst = 0.0;
  for (std::uint32_t x = 0; x < wanted.width; ++x) {
    const double truth = half_plane_visibility(half * (2.0 * (x + 0.5) / wanted.width - 1.0));
    worst = std::max(worst, std::abs(result.visibility.at(x, 32, 0) - truth));
  }
  // Bilinear alpha crosses one half where the texels meet: there is the edge of the other scene.
  EXPECT_LT(worst, 0.006);
}

TEST_F(ReferencePicture, IsOpaqueWhereNoAlphaIsBelowTheCutoff) {
  const RenderResult result = render(request(half_open_plate(0.0f), "reference"));
  for (const float visibility : result.visibility.pixels) EXPECT_EQ(visibility, 0.0f);
}

TEST_F(ReferencePicture, ChargesHierarchyAndMaskToTheTechnique) {
  const auto scene = scenes::load("disco-box");
  const RenderResult result = render(request(scene, "reference"));
  std::map<std::string, std::uint64_t> bytes;
  for (const ResourceCost& resource : result.cost.technique_memory)
    bytes[resource.name] = resource.bytes;
  EXPECT_GE(bytes["occlusion masks"], scene->lights.size() * 64 * 64 * 4);
  // One hierarchy for all lights: 48 bytes a triangle, and 2n - 1 nodes of 32 bytes.
  std::uint64_t triangles = 0;
  for (const Instance& instance : scene->instances)
    if (instance.casts_shadow) triangles += scene->meshes[instance.mesh].indices.size() / 3;
  EXPECT_GT(scene->lights.size(), 1u);
  EXPECT_EQ(bytes["hierarchy triangles"], triangles * 48);
  EXPECT_EQ(bytes["hierarchy nodes"], (2 * triangles - 1) * 32);
}

TEST_F(ReferencePicture, SoftensWithTheRaysOfRayTracing) {
  RenderRequest wanted = request("half-plane", "reference", {{"mode", "visibility"}});
  wanted.light_samples = 1024;
  const RenderResult reference = render(wanted);
  double last = 1.0;
  for (const std::int64_t rays : {1, 8, 64}) {
    const RenderResult traced = render(request("half-plane", "ray-traced", {{"rays", rays}}));
    const double rms =
        tests::visibility_error(traced.visibility, reference.visibility, reference.judged).rms;
    EXPECT_LT(rms, 0.5 * last) << rays << " rays";
    last = rms;
  }
  EXPECT_LT(last, 0.01);
}

}  // namespace
}  // namespace penumbra
