// Pictures that are drawn in parts: windows of many samples, rounds of many light points.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "renderer/error.h"
#include "renderer/frame/rounds.h"
#include "renderer/frame/window.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace {

class PicturesInParts : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    renderer_ = new Renderer({"", true});
    RendererOptions small{"", true};
    small.most_window_samples = 4096;
    in_windows_ = new Renderer(small);
  }
  static void TearDownTestSuite() {
    delete renderer_;
    delete in_windows_;
    renderer_ = in_windows_ = nullptr;
  }

  static RenderRequest request(const std::string& scene, const std::string& technique,
                               std::uint32_t size, std::uint32_t samples) {
    const auto resolved = techniques::resolve(technique, {});
    RenderRequest made;
    made.scene = scenes::load(scene);
    made.technique = resolved.technique;
    made.parameters = resolved.parameters;
    made.width = size;
    made.height = size * 3 / 4;
    made.light_samples = samples;
    made.visibility = made.linear = true;
    return made;
  }

  static inline Renderer* renderer_ = nullptr;
  static inline Renderer* in_windows_ = nullptr;  ///< draws 4096 samples at a time
};

TEST(Windows, cover_every_pixel_within_the_limits) {
  for (const auto& [width, height, side] :
       {std::tuple{600u, 600u, 1u}, {1000u, 3u, 4u}, {1u, 1u, 4u}, {7u, 5000u, 2u}}) {
    const auto windows = cover(width, height, side, 20000, 1024);
    std::vector<int> covered(std::size_t{width} * height, 0);
    for (const Window& window : windows) {
      EXPECT_EQ(window.width, windows.front().width);
      EXPECT_EQ(window.height, windows.front().height);
      EXPECT_LE(window.width * window.height * side * side, 20000u);
      EXPECT_LE(std::max(window.width, window.height) * side, 1024u);
      for (std::uint32_t y = 0; y < window.height; ++y)
        for (std::uint32_t x = 0; x < window.width; ++x)
          ++covered.at((window.y + y) * width + window.x + x);
    }
    EXPECT_EQ(std::count(covered.begin(), covered.end(), 0), 0);
  }
  EXPECT_EQ(cover(600, 600, 1, 1u << 24, 16384).size(), 1u);
}

TEST(Rounds, hold_every_point_once_and_double_under_a_bound) {
  for (const std::uint32_t samples : {1u, 255u, 1000u, 1024u, 4097u, 65536u})
    for (const bool bounded : {false, true}) {
      std::uint32_t next = 0;
      for (const PointRange& round : rounds_of(samples, bounded)) {
        EXPECT_EQ(round.first, next);
        next += round.count;
      }
      EXPECT_EQ(next, samples);
    }
  const std::vector<PointRange> bounded{{0, 256}, {256, 256}, {512, 512}};
  EXPECT_EQ(rounds_of(1024, true), bounded);
  EXPECT_EQ(rounds_of(1024, false).size(), 1u);
}

/// Rounding moves vertices by a hair between the windows' cameras: single pixels at edges may
/// differ.
TEST_F(PicturesInParts, ShowTheSameWindowByWindow) {
  for (const char* technique : {"none", "shadow-map", "pcss", "vsm", "shadow-volumes",
                                "shadow-volumes-zpass-plus", "soft-shadow-volumes", "hybrid",
                                "projected", "occluder-textures", "ray-traced", "reference"}) {
    const RenderRequest wanted = request("boxes", technique, 160, 32);
    const RenderResult whole = renderer_->render(wanted);
    std::vector<double> shares;
    const RenderResult parts =
        in_windows_->render(wanted, {[&](double share) { shares.push_back(share); }, {}, {}});
    ASSERT_EQ(parts.picture.pixels.size(), whole.picture.pixels.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < whole.picture.pixels.size(); i += 4) {
      int most = 0;
      for (std::size_t c = 0; c < 4; ++c)
        most = std::max(most, std::abs(whole.picture.pixels[i + c] - parts.picture.pixels[i + c]));
      different += most > 1;
    }
    EXPECT_LE(different, whole.picture.pixel_count() / 500) << technique;
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end())) << technique;
    EXPECT_EQ(shares.back(), 1.0) << technique;
  }
}

TEST_F(PicturesInParts, MayHaveMoreSamplesThanAnImageOfTheDevice) {
  RenderRequest wanted = request("half-plane", "none", 16384, 1);
  wanted.height = 2;
  wanted.supersampling = 16;
  wanted.linear = wanted.visibility = false;
  const RenderResult drawn = renderer_->render(wanted);
  EXPECT_EQ(drawn.picture.width, 16384u);
  EXPECT_EQ(drawn.non_finite_pixels, 0u);
}

TEST_F(PicturesInParts, AverageRoundsOfPointsToTheMeanOfAll) {
  // Rounds of one sequence: together the very points that are drawn at once without a bound, but
  // for fully lit samples, which are drawn with fewer: these may differ by a twentieth of a level.
  RenderRequest wanted = request("half-plane", "reference", 48, 1024);
  wanted.uncertainty = true;
  const RenderResult at_once = renderer_->render(wanted);
  wanted.error_bound = 1e-6;
  const RenderResult in_rounds = renderer_->render(wanted);
  EXPECT_EQ(in_rounds.light_samples, 1024u);
  for (std::size_t i = 0; i < at_once.linear.pixels.size(); ++i)
    ASSERT_NEAR(in_rounds.linear.pixels[i], at_once.linear.pixels[i], 2e-4f);
  for (std::size_t i = 0; i < at_once.visibility.pixels.size(); ++i)
    ASSERT_NEAR(in_rounds.visibility.pixels[i], at_once.visibility.pixels[i], 2e-4f);
  ASSERT_TRUE(in_rounds.noise_rms_y && at_once.noise_rms_y);
  EXPECT_NEAR(*in_rounds.noise_rms_y, *at_once.noise_rms_y, 0.01 * *at_once.noise_rms_y);
  EXPECT_LE(tests::rms_y(in_rounds.picture, at_once.picture), 0.05);
}

TEST_F(PicturesInParts, BeginWithAsFewPointsOfASampleAsABatchHas) {
  // 256 points are 16 of each of 16 samples: the rounds to come have several batches.
  RenderRequest wanted = request("boxes", "reference", 32, 4096);
  wanted.supersampling = 16;
  const RenderResult at_once = renderer_->render(wanted);
  wanted.error_bound = 1e-6;
  const RenderResult in_rounds = renderer_->render(wanted);
  EXPECT_EQ(in_rounds.light_samples, 4096u);
  EXPECT_LE(tests::rms_y(in_rounds.picture, at_once.picture), 0.25);
  // Nor may a window see what the one before it has found.
  EXPECT_LE(tests::rms_y(in_windows_->render(wanted).picture, at_once.picture), 0.25);
}

TEST_F(PicturesInParts, StopOnceTheErrorIsWithinItsBound) {
  RenderRequest wanted = request("boxes", "reference", 80, 65536);
  wanted.error_bound = 0.3;
  const RenderResult stopped = renderer_->render(wanted);
  EXPECT_LT(stopped.light_samples, 65536u);
  ASSERT_TRUE(stopped.noise_rms_y);
  EXPECT_LE(*stopped.noise_rms_y, 0.3);
  // The promise, judged by other points many times as many.
  wanted.error_bound = 0.0;
  wanted.light_samples = 16384;
  wanted.seed = 77;
  EXPECT_LE(tests::rms_y(stopped.picture, renderer_->render(wanted).picture), 2.0 * 0.3);
}

TEST_F(PicturesInParts, SayWhereTheirErrorCannotBeBounded) {
  RenderRequest wanted = request("boxes", "reference", 40, 40);
  wanted.error_bound = 0.5;
  try {
    renderer_->render(wanted);
    FAIL() << "promised an error that it does not know";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "unsupported");
    EXPECT_EQ(error.field, "error_bound");
  }
  wanted.error_bound = std::nan("");
  EXPECT_THROW(renderer_->render(wanted), Error);
}

/// Draws until the given part is done, breaks off, and draws the rest from what was kept.
RenderResult broken_off(Renderer& renderer, const RenderRequest& wanted, int parts) {
  struct Killed {};
  std::string state;
  int count = 0;
  RenderControl control;
  control.between_parts = [&](const std::function<std::string()>& make) {
    if (++count < parts) return;
    state = make();
    throw Killed();
  };
  EXPECT_THROW(renderer.render(wanted, control), Killed);
  RenderControl rest;
  rest.resume = state;
  return renderer.render(wanted, rest);
}

TEST_F(PicturesInParts, AreTakenUpAgainToTheSameBytes) {
  RenderRequest wanted = request("half-plane", "reference", 40, 2048);
  wanted.error_bound = 1e-6;
  wanted.uncertainty = true;
  for (Renderer* renderer : {renderer_, in_windows_}) {
    const RenderResult whole = renderer->render(wanted);
    const RenderResult resumed = broken_off(*renderer, wanted, 3);
    EXPECT_TRUE(tests::same(resumed.picture, whole.picture));
    EXPECT_TRUE(tests::same(resumed.linear, whole.linear));
    EXPECT_TRUE(tests::same(resumed.visibility, whole.visibility));
    EXPECT_TRUE(tests::same(resumed.uncertainty, whole.uncertainty));
    EXPECT_NE(resumed.notes, whole.notes);
  }
}

TEST_F(PicturesInParts, BeginAnewFromAStateThatIsNotTheirs) {
  RenderRequest wanted = request("half-plane", "reference", 24, 1024);
  wanted.error_bound = 1e-6;
  const RenderResult whole = renderer_->render(wanted);
  std::string state;
  RenderControl control;
  control.between_parts = [&](const std::function<std::string()>& make) { state = make(); };
  RenderRequest other = wanted;
  other.width = 32;
  renderer_->render(other, control);
  for (const std::string& bytes : {state, state.substr(0, 20), std::string("nonsense")}) {
    RenderControl rest;
    rest.resume = bytes;
    EXPECT_TRUE(tests::same(renderer_->render(wanted, rest).picture, whole.picture));
  }
}

}  // namespace
}  // namespace penumbra::tests
