#include <gtest/gtest.h>

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "renderer/error.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"
#include "tracer.h"

namespace penumbra::tests {
namespace {

class ReferenceUncertainty : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { renderer_ = new Renderer({"", true}); }
  static void TearDownTestSuite() {
    delete renderer_;
    renderer_ = nullptr;
  }

  static RenderRequest request(const std::shared_ptr<const Scene>& scene, std::uint32_t size,
                               std::uint32_t samples, const ParameterValues& parameters = {}) {
    const auto resolved = techniques::resolve("reference", parameters);
    RenderRequest made;
    made.scene = scene;
    made.technique = resolved.technique;
    made.parameters = resolved.parameters;
    made.width = made.height = size;
    made.light_samples = samples;
    made.visibility = made.linear = made.uncertainty = true;
    return made;
  }
  static RenderResult render(const RenderRequest& wanted) { return renderer_->render(wanted); }

  static inline Renderer* renderer_ = nullptr;
};

double encoded(double linear) {  // IEC 61966-2-1, 0..255
  const double c = std::clamp(linear, 0.0, 1.0);
  return 255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055);
}

double brightness(const ImageF& linear, std::size_t pixel) {
  const float* rgb = &linear.pixels[pixel * linear.channels];
  return 0.299 * encoded(rgb[0]) + 0.587 * encoded(rgb[1]) + 0.114 * encoded(rgb[2]);
}

/// What Embree finds of a light with 16 scrambles of its own: mean visibility and the variance of a
/// scramble's.
struct Estimate {
  double mean = 0.0;
  double variance = 0.0;
};

Estimate embree_visibility(const Embree& embree, const Receiver& receiver, float rounding,
                           const std::vector<glm::vec4>& points) {
  constexpr std::size_t scrambles = 16;
  std::array<double, scrambles> lit{};
  for (std::size_t i = 0; i < points.size(); ++i)
    lit[i % scrambles] +=
        embree.hidden(receiver, rounding, glm::vec4(glm::vec3(points[i]), 1.0f)) ? 0.0 : 1.0;
  Estimate estimate;
  for (double& share : lit) {
    share *= static_cast<double>(scrambles) / static_cast<double>(points.size());
    estimate.mean += share / scrambles;
  }
  for (const double share : lit)
    estimate.variance += (share - estimate.mean) * (share - estimate.mean) / (scrambles - 1);
  return estimate;
}

TEST_F(ReferenceUncertainty, PassesATestOfEveryPixelAgainstEmbreesOwnScrambles) {
  constexpr std::uint32_t size = 64, samples = 512;
  const auto scene = scenes::load("boxes");
  const RenderResult ours = render(request(scene, size, samples));
  const Tracer tracer(scene);
  const GpuScene& gpu = tracer.scene();
  const Embree embree(gpu);
  const CameraMatrices camera = camera_matrices(scene->cameras.front(), gpu.origin(), 1.0, 1.0);
  const auto receivers = embree.receivers(camera, size);
  const WorldLight light = world_light(scene->lights.front(), gpu.origin());
  const auto points = light_points(light, samples, 1, 12345, false, 16);

  std::size_t tested = 0, failed = 0, uncertain = 0;
  double squares = 0.0;
  // Sidak: all pixels together are wrong with probability 0.01 if each is with this one.
  const double alpha = 1.0 - std::pow(0.99, 1.0 / (size * size));
  const double limit = boost::math::quantile(boost::math::students_t(15.0), 1.0 - 0.5 * alpha);
  for (std::size_t p = 0; p < receivers.size(); ++p) {
    if (!receivers[p].surface || ours.judged.pixels[p] < 1.0f) continue;
    const float rounding = reference::rounding_of(gpu, receivers[p].position, camera.position);
    const Estimate truth = embree_visibility(embree, receivers[p], rounding, points);
    const double difference = static_cast<double>(ours.visibility.pixels[p]) - truth.mean;
    ++tested;
    if (truth.variance == 0.0) {
      failed += std::abs(difference) > 1e-5;
      continue;
    }
    // Ours has as many points, and so the same variance.
    const double z = difference / std::sqrt(2.0 * truth.variance / 16.0);
    failed += std::abs(z) > limit;
    squares += z * z;
    ++uncertain;
  }
  EXPECT_GT(tested, 3000u);
  EXPECT_GT(uncertain, 100u);
  EXPECT_LE(failed, tested / 400) << "of " << tested << " pixels";
  // Student's t with 15 degrees of freedom has the variance 15/13. Pixels share their points, hence
  // the wide margin.
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(uncertain)), 1.07, 0.4);
}

TEST_F(ReferenceUncertainty, TellsHowFarAPictureIsFromASixteenfoldFinerOne) {
  for (const char* sampling : {"low-discrepancy", "random"}) {
    SCOPED_TRACE(sampling);
    RenderRequest wanted =
        request(scenes::load("boxes"), 56, 1024, {{"sampling", std::string(sampling)}});
    const RenderResult coarse = render(wanted);
    wanted.light_samples = 16384;
    wanted.seed = 99;
    const RenderResult fine = render(wanted);
    double squares = 0.0;
    for (std::size_t p = 0; p < coarse.linear.pixel_count(); ++p)
      squares += std::pow(brightness(coarse.linear, p) - brightness(fine.linear, p), 2.0);
    const double error = std::sqrt(squares / static_cast<double>(coarse.linear.pixel_count()));
    ASSERT_TRUE(coarse.noise_rms_y && fine.noise_rms_y);
    // A root of 16 at least, less where few points are shaded.
    EXPECT_LT(*fine.noise_rms_y, 0.5 * *coarse.noise_rms_y);
    const double told = std::hypot(*coarse.noise_rms_y, *fine.noise_rms_y);
    // All pixels share their points: the error of the whole has few degrees of freedom.
    EXPECT_LT(error, 2.0 * told);
    EXPECT_GT(error, 0.5 * told);
  }
}

TEST_F(ReferenceUncertainty, IsGreatInPenumbrasAndNoughtInTheShade) {
  const RenderResult result = render(request(scenes::load("half-plane"), 64, 256));
  double penumbra = 0.0, shade = 0.0;
  for (std::size_t p = 0; p < result.uncertainty.pixels.size(); ++p) {
    const double error = static_cast<double>(result.uncertainty.pixels[p]);
    const float visibility = result.visibility.pixels[p];
    if (visibility == 0.0f) shade = std::max(shade, error);
    if (visibility > 0.2f && visibility < 0.8f) penumbra = std::max(penumbra, error);
  }
  EXPECT_EQ(shade, 0.0);
  EXPECT_GT(penumbra, 0.05);
}

TEST_F(ReferenceUncertainty, IsUnknownWherePointsDoNotMakeSixteenSets) {
  EXPECT_TRUE(render(request(scenes::load("half-plane"), 16, 48)).noise_rms_y);
  EXPECT_FALSE(render(request(scenes::load("half-plane"), 16, 40)).noise_rms_y);
  RenderRequest wanted = request(scenes::load("half-plane"), 16, 40);
  wanted.diagnostic = "uncertainty";
  try {
    render(wanted);
    FAIL() << "drew an error that it does not know";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "unsupported");
    EXPECT_EQ(error.field, "light_samples");
  }
}

/// Root mean square error of visibility over the penumbra of an edge, known in closed form, and
/// over seeds: see reference_test.cpp.
double edge_error(Renderer& renderer, RenderRequest wanted, std::uint32_t samples) {
  wanted.light_samples = samples;
  wanted.uncertainty = wanted.linear = false;
  const double half = 0.8 * std::tan(std::acos(-1.0) / 6.0);
  double squares = 0.0;
  std::size_t count = 0;
  for (wanted.seed = 1; wanted.seed <= 6; ++wanted.seed) {
    const RenderResult result = renderer.render(wanted);
    for (std::uint32_t x = 0; x < wanted.width; ++x) {
      const double place = half * (2.0 * (x + 0.5) / wanted.width - 1.0);
      const double truth = std::clamp(
          0.5 - std::max(place * (1.0 - 4.0 / 0.9995), place * (1.0 - 4.0 / 1.0005)), 0.0, 1.0);
      if (truth <= 0.0 || truth >= 1.0) continue;
      squares += std::pow(static_cast<double>(result.visibility.at(x, 0, 0)) - truth, 2.0);
      ++count;
    }
  }
  return std::sqrt(squares / static_cast<double>(count));
}

TEST_F(ReferenceUncertainty, FallsAsTheRootOfRandomPointsAndFasterForEvenOnes) {
  const auto scene = scenes::load("half-plane");
  const RenderRequest even = request(scene, 24, 16);
  const RenderRequest random = request(scene, 24, 16, {{"sampling", std::string("random")}});
  const double even_slope =
      std::log(edge_error(*renderer_, even, 4096) / edge_error(*renderer_, even, 256)) /
      std::log(16.0);
  const double random_slope =
      std::log(edge_error(*renderer_, random, 4096) / edge_error(*renderer_, random, 256)) /
      std::log(16.0);
  EXPECT_NEAR(random_slope, -0.5, 0.15);
  EXPECT_LT(even_slope, -0.75);
}

}  // namespace
}  // namespace penumbra::tests
