// Exponential, exponential variance and moment shadow maps against closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drawing.h"
#include "plates.h"
#include "renderer/error.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace exponential_test {

constexpr std::uint32_t size = 64;  // texels of the map and pixels of its picture
constexpr std::uint32_t on_plate = 30 * 30;

/// Texels of the filtered map that hold no finite number: magenta on the diagnostic picture.
std::uint32_t overflowed_texels(const std::string& technique, ParameterValues parameters) {
  parameters["map_size"] = std::int64_t{size};
  parameters.try_emplace("blur", std::int64_t{0});
  RenderRequest with_map =
      request(std::make_shared<const Scene>(plate_over_ground()), technique, parameters, size);
  with_map.diagnostic = "moments";
  const Image8 picture = renderer().render(with_map).diagnostic;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
    count += picture.pixels[i] == 255 && picture.pixels[i + 1] == 0 && picture.pixels[i + 2] == 255;
  return count;
}

TEST(Overflow, linear_exponentials_leave_single_floats_above_88) {
  // log of the greatest float is 88.7228; the plate lies at depth 0, the ground near 1.
  EXPECT_EQ(overflowed_texels("esm-linear", {{"c", 80.0}}), 0u);
  EXPECT_EQ(overflowed_texels("esm-linear", {{"c", 88.0}}), 0u);
  EXPECT_EQ(overflowed_texels("esm-linear", {{"c", 90.0}}), size * size - on_plate);
  EXPECT_EQ(overflowed_texels("esm-linear", {{"c", 150.0}}), size * size - on_plate);
}

TEST(Overflow, texels_that_no_caster_covers_are_the_first_to_overflow) {
  // 88.73 passes the limit at depth 1, not on the ground at 1 / 1.0001. The ground is 61 texels
  // wide and its border runs through the middle of texels.
  const std::uint32_t count = overflowed_texels("esm-linear", {{"c", 88.73}});
  EXPECT_GE(count, size * size - 62u * 62u);
  EXPECT_LE(count, size * size - 60u * 60u);
}

TEST(Overflow, sums_of_a_wide_blur_stay_within_what_their_mean_needs) {
  for (const char* filter : {"box", "gauss"})
    EXPECT_EQ(overflowed_texels(
                  "esm-linear",
                  {{"c", 88.0}, {"blur", std::int64_t{16}}, {"blur_filter", std::string(filter)}}),
              0u);
}

TEST(Overflow, logarithms_never_overflow) {
  for (const double c : {88.0, 90.0, 150.0, 1000.0})
    EXPECT_EQ(overflowed_texels("esm-log", {{"c", c}, {"blur", std::int64_t{3}}}), 0u) << c;
}

TEST(Overflow, sixteen_bits_hold_exponentials_up_to_11) {
  const ParameterValue half = std::string("fp16");  // greatest value 65504, its logarithm 11.09
  EXPECT_EQ(overflowed_texels("esm", {{"c", 11.0}, {"precision", half}}), 0u);
  EXPECT_EQ(overflowed_texels("esm", {{"c", 12.0}, {"precision", half}}), size * size - on_plate);
}

TEST(Overflow, squares_of_exponentials_overflow_at_half_of_that) {
  const ParameterValue half = std::string("fp16");
  EXPECT_EQ(overflowed_texels("evsm", {{"c_positive", 44.0}}), 0u);
  EXPECT_EQ(overflowed_texels("evsm", {{"c_positive", 45.0}}), size * size - on_plate);
  EXPECT_EQ(overflowed_texels("evsm-2", {{"c_positive", 45.0}}), size * size - on_plate);
  EXPECT_EQ(overflowed_texels("evsm", {{"c_positive", 5.5}, {"precision", half}}), 0u);
  EXPECT_EQ(overflowed_texels("evsm", {{"c_positive", 6.0}, {"precision", half}}),
            size * size - on_plate);
}

TEST(Overflow, shows_in_the_picture_and_is_counted) {
  Scene scene = plate_over_ground();
  scene.cameras[0].position.y = 3.0;
  scene.cameras[0].orthographic_height = 3.0;
  EXPECT_EQ(draw(scene, "esm-linear", {{"c", 88.0}}).non_finite_pixels, 0u);
  EXPECT_GT(draw(scene, "esm-linear", {{"c", 90.0}}).non_finite_pixels, 1000u);
  EXPECT_EQ(draw(scene, "esm-log", {{"c", 150.0}}).non_finite_pixels, 0u);
  EXPECT_EQ(draw(scene, "evsm", {{"c_positive", 44.0}}).non_finite_pixels, 0u);
  EXPECT_GT(draw(scene, "evsm", {{"c_positive", 45.0}}).non_finite_pixels, 1000u);
}

TEST(Exponential, logarithms_are_refused_where_a_sampler_would_average_them) {
  for (const char* name : {"mips", "anisotropic"}) {
    try {
      draw(plate_over_ground(), "esm-log", {{name, true}}, 8);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, "unsupported");
      EXPECT_EQ(error.field, name);
    }
  }
}

TEST(Exponential, light_leaks_in_at_contacts_by_the_exponential_of_the_gap) {
  // A plate 0.1 m over the ground in a range of 4 m: exp(-c 0.1 / 4) of the light remains.
  Scene scene = plate_over_ground(0.1);
  add_plate(scene, {1.9, 1.9}, {2, 2}, 4.0);
  scene.cameras[0].orthographic_height = 0.5;
  for (const char* technique : {"esm-linear", "esm-log"})
    for (const double c : {20.0, 40.0, 88.0})
      for (const float lit :
           draw(
               scene, technique,
               {{"c", c}, {"mips", false}, {"fallback", std::string("none")}, {"slope_scale", 0.0}},
               4)
               .visibility.pixels)
        ASSERT_NEAR(lit, std::exp(-c * 0.1 / 4.0), 1e-3) << technique << ", c " << c;
}

/// A picture's red pixels: where percentage-closer filtering takes over.
double fallback_share(const std::shared_ptr<const Scene>& scene,
                      const ParameterValues& parameters) {
  RenderRequest with_mask = request(scene, "esm-linear", parameters, 100);
  with_mask.diagnostic = "fallback";
  const Image8 picture = renderer().render(with_mask).diagnostic;
  double red = 0.0;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 4)
    red += picture.pixels[i] > 250 && picture.pixels[i + 1] < 100;
  return red / static_cast<double>(picture.pixel_count());
}

TEST(Exponential, the_fallback_grows_with_the_kernel) {
  const auto scene = scenes::load("boxes");
  const auto share = [&](const char* kind, std::int64_t blur) {
    return fallback_share(scene, {{"blur", blur}, {"fallback", std::string(kind)}});
  };
  const double three = share("threshold", 1);
  EXPECT_GT(three, 0.01);
  EXPECT_GT(share("threshold", 3), three);
  EXPECT_GT(share("threshold", 5), share("threshold", 3));
  EXPECT_GT(share("z-max", 5), share("z-max", 1));
}

TEST(Exponential, the_fallback_lies_on_slanted_surfaces) {
  for (const double angle : {0.0, 60.0}) {
    Scene scene = empty_scene(8.0, 0.3);
    add_plate(scene, {-2, -2}, {2, 2}, 0.0);
    const double s = std::sin(glm::radians(angle)), c = std::cos(glm::radians(angle));
    scene.instances[0].world_from_object =
        glm::dmat4(c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    add_plate(scene, {1.9, 1.9}, {2, 2}, 3.0);  // the range of depths hardly changes with the angle
    scene.lights.push_back(sun());
    const double share = fallback_share(std::make_shared<const Scene>(scene),
                                        {{"blur", std::int64_t{5}}, {"mips", false}});
    if (angle == 0.0)
      EXPECT_EQ(share, 0.0);
    else
      EXPECT_GT(share, 0.95);
  }
}

/// Two parallel layers: a blurred map holds two depths, of which a share p is the caster's. All
/// bounds then are 1 - p, which percentage-closer filtering counts.
class TwoLayers : public testing::TestWithParam<const char*> {};

TEST_P(TwoLayers, equal_percentage_closer_filtering) {
  Scene scene = empty_scene(0.8, 1.0);
  add_plate(scene, {-3, -3}, {3, 3}, 0.0);
  add_plate(scene, {-2, -3}, {0, 3}, 1.0);
  scene.lights.push_back(lamp({0, 4, 0}, 40));
  for (const std::int64_t radius : {1, 4}) {
    ParameterValues parameters{{"blur", radius},
                               {"blur_filter", std::string("box")},
                               {"mips", false},
                               {"slope_scale", 0.0},
                               {"bias", 0.001}};
    const std::string technique = GetParam();
    if (technique.starts_with("esm")) parameters["fallback"] = std::string("none");
    if (technique.starts_with("msm")) parameters["bleeding_reduction"] = 0.0;
    const RenderResult bound = draw(scene, technique, parameters, 100);
    const RenderResult counted = draw(scene, "pcf", {{"kernel", 2 * radius + 1}}, 100);
    const auto error =
        tests::visibility_error(bound.visibility, counted.visibility, counted.judged);
    EXPECT_LT(error.rms, 0.02) << radius;
  }
}

INSTANTIATE_TEST_SUITE_P(Filters, TwoLayers,
                         testing::Values("esm-linear", "esm-log", "evsm", "evsm-2", "msm",
                                         "msm-64"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

/// Brightest point of the ground under a plate `gap` metres over it, which shadows all that is
/// seen; a second plate, 3 m over the ground, covers half of the first.
float leak(const std::string& technique, double gap, bool second, ParameterValues parameters = {}) {
  Scene scene = empty_scene(0.8 * gap, 1.0);
  add_plate(scene, {-2, -2}, {2, 2}, 0.0);
  add_plate(scene, {-1.5, -1.5}, {1.5, 1.5}, gap);
  add_plate(scene, {second ? -2.0 : 1.9, -2}, {second ? 0.0 : 2.0, 2}, 3.0);
  scene.lights.push_back(sun());
  parameters["blur"] = std::int64_t{6};
  parameters["blur_filter"] = std::string("box");
  parameters["slope_scale"] = 0.0;
  if (!technique.starts_with("esm")) parameters["bleeding_reduction"] = 0.0;
  const RenderResult result = draw(scene, technique, parameters, 50);
  return *std::max_element(result.visibility.pixels.begin(), result.visibility.pixels.end());
}

TEST(Bleeding, two_warps_remove_what_two_moments_let_through) {
  // Half of the kernel at 3 m, half at 0.5 m: the variance is 1.25^2 and the mean lies 1.75 m
  // before the ground. Chebyshev's bound of that is 0.338; its greatest over all shares is more.
  EXPECT_GT(leak("vsm", 0.5, true), 0.338f);
  EXPECT_LT(leak("evsm", 0.5, true), 0.01f);
  EXPECT_LT(leak("evsm-2", 0.5, true), 0.01f);
  // A low constant is not enough (Adorjan 2013, fig. 4.11a).
  EXPECT_GT(leak("evsm", 0.5, true, {{"c_positive", 5.0}}), 0.05f);
}

TEST(Bleeding, two_warps_remove_the_exponentials_leak_at_contacts) {
  EXPECT_NEAR(leak("esm-linear", 0.05, false), std::exp(-88.0 * 0.05 / 3.0), 0.01);
  EXPECT_LT(leak("evsm", 0.05, false), 0.02f);
}

TEST(Bleeding, four_moments_know_two_layers_apart) {
  EXPECT_LT(leak("msm", 0.5, true), 0.1f * leak("vsm", 0.5, true));
  EXPECT_LT(leak("msm-64", 0.5, true), 0.3f * leak("vsm", 0.5, true));
}

}  // namespace exponential_test
}  // namespace penumbra::tests
