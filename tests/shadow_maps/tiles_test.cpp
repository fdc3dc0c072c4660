// Layouts of tiles: bytes, ranks, importance, borders, what is drawn, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "avenue.h"
#include "drawing.h"
#include "hard_truth.h"
#include "renderer/error.h"
#include "renderer/shadow_maps/texels/tiles.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace tiles_test {

constexpr std::uint32_t picture = 128;

std::vector<std::string> tile_layouts() {
  std::vector<std::string> ids;
  for (const shadow_maps::Layout& layout : shadow_maps::layouts())
    if (layout.ranking != shadow_maps::TileRanking::none) ids.push_back(layout.id);
  return ids;
}

/// Numbers of the note that begins, after the light's name, with a text, up to another.
std::vector<double> noted(const RenderResult& result, const std::string& from,
                          const std::string& to = {}) {
  for (const std::string& note : result.notes) {
    const std::size_t begin = note.find(from);
    if (begin == std::string::npos) continue;
    const std::size_t end = to.empty() ? std::string::npos : note.find(to, begin);
    std::vector<double> numbers;
    std::istringstream text(note.substr(begin + from.size(), end - begin - from.size()));
    for (std::string number; std::getline(text, number, ',');) numbers.push_back(std::stod(number));
    return numbers;
  }
  return {};
}

std::vector<double> sizes_of(const RenderResult& result) {
  return noted(result, "its tiles have texels a side: ", ";");
}

std::vector<double> importance_of(const RenderResult& result) {
  return noted(result, "; importance: ");
}

TEST(Tiles, take_exactly_the_published_bytes) {
  for (const std::string& layout : tile_layouts())
    for (const std::int64_t map_size : {16, 2048}) {
      const RenderResult result =
          draw(avenue(), "shadow-map", {{"layout", layout}, {"map_size", map_size}}, 32);
      const auto& memory = result.cost.technique_memory;
      const auto map = std::find_if(memory.begin(), memory.end(), [](const ResourceCost& cost) {
        return cost.name == "shadow map";
      });
      ASSERT_NE(map, memory.end());
      EXPECT_EQ(map->bytes, 6860800u) << layout;
    }
}

TEST(Tiles, have_the_published_sizes_by_importance) {
  const RenderResult result = draw(avenue(), "shadow-map", {{"layout", "iasm"}}, picture);
  const auto sizes = sizes_of(result);
  const auto importance = importance_of(result);
  ASSERT_EQ(sizes.size(), 16u);
  ASSERT_EQ(importance.size(), 16u);
  EXPECT_THAT(sizes, testing::UnorderedElementsAre(1024, 512, 512, 256, 128, 128, 128, 128, 64, 64,
                                                   32, 32, 16, 16, 16, 16));
  for (std::size_t a = 0; a < 16; ++a)
    for (std::size_t b = 0; b < 16; ++b)
      if (importance[a] > importance[b]) {
        EXPECT_GE(sizes[a], sizes[b]);
      }
}

TEST(Tiles, that_matter_alike_rank_in_order) {
  std::array<std::uint32_t, 16> importance{};
  importance[5] = 7;
  importance[9] = 7;
  importance[2] = 9;
  const auto ranks = shadow_maps::tile_ranks(importance);
  EXPECT_THAT(ranks, testing::ElementsAre(3, 4, 0, 5, 6, 1, 7, 8, 9, 2, 10, 11, 12, 13, 14, 15));
}

TEST(Importance, sums_never_overflow_and_are_as_fine_as_they_can_be) {
  for (const double gain : {0.0, 1.0, 8.0, 1024.0})
    for (const std::uint64_t samples : {1ull, 1280ull * 720ull, 1024ull * 1024ull, 1ull << 34}) {
      const int scale = shadow_maps::importance_scale(samples, gain);
      const double most = std::ldexp((1.0 + gain) * static_cast<double>(samples), scale);
      EXPECT_LT(most, 4294967296.0);
      EXPECT_GE(2.0 * most, 2147483648.0);
    }
  // As reckoned by hand for 1280x720: no more than 12 - log2(1 + m).
  EXPECT_EQ(shadow_maps::importance_scale(1280 * 720, 0.0), 12);
  EXPECT_EQ(shadow_maps::importance_scale(1280 * 720, 1.0), 11);
}

/// Sum over the picture's samples of the ground of plain(), whose depth before the camera is known
/// in closed form.
double importance_of_plain(const Scene& scene, std::uint32_t samples, double gain, double range) {
  const Camera& camera = scene.cameras[0];
  const glm::dvec3 ahead = glm::normalize(camera.target - camera.position);
  const glm::dvec3 right = glm::normalize(glm::cross(ahead, camera.up));
  const glm::dvec3 up = glm::cross(right, ahead);
  const double tangent = std::tan(glm::radians(0.5 * camera.vertical_fov));
  double sum = 0.0;
  for (std::uint32_t y = 0; y < samples; ++y)
    for (std::uint32_t x = 0; x < samples; ++x) {
      const glm::dvec3 ray = ahead + tangent * ((2.0 * (x + 0.5) / samples - 1.0) * right +
                                                (1.0 - 2.0 * (y + 0.5) / samples) * up);
      if (ray.y >= 0.0) continue;
      const double depth = camera.position.y / -ray.y;  // of a ray of unit depth
      const glm::dvec3 place = camera.position + depth * ray;
      if (std::abs(place.x) > 40.0 || place.z < -120.0 || place.z > 10.0) continue;
      sum += 1.0 + gain * std::clamp(1.0 - depth / range, 0.0, 1.0);
    }
  return sum;
}

TEST(Importance, is_that_of_the_depth_of_every_sample_at_16_a_pixel_too) {
  Scene scene = plain();
  scene.lights.push_back(slanted_sun({0.7, -1.0, -0.3}));
  for (const std::int64_t samples : {1, 16}) {
    const ParameterValues parameters{
        {"layout", "iasm"}, {"importance_range", 25.0}, {"importance_gain", 1000.0}};
    RenderRequest asked =
        request(std::make_shared<const Scene>(scene), "shadow-map", parameters, picture);
    asked.supersampling = static_cast<std::uint32_t>(samples);
    const auto importance = importance_of(renderer().render(asked));
    ASSERT_EQ(importance.size(), 16u);
    const double sum = std::accumulate(importance.begin(), importance.end(), 0.0);
    const auto side = static_cast<std::uint32_t>(picture * (samples == 16 ? 4 : 1));
    const double expected = importance_of_plain(scene, side, 1000.0, 25.0);
    EXPECT_NEAR(sum / expected, 1.0, 0.003) << samples;
  }
}

TEST(Tiles, give_the_same_picture_however_they_are_ranked) {
  const Scene scene = avenue();
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  for (const char* technique : {"shadow-map", "pcf-bilinear-3x3", "pcss"}) {
    SCOPED_TRACE(technique);
    const RenderResult first = draw(scene, technique, {{"layout", "iasm"}}, picture);
    for (const std::string& layout : tile_layouts()) {
      const RenderResult result = draw(scene, technique, {{"layout", layout}}, picture);
      std::size_t different = 0;
      for (std::size_t i = 0; i < result.visibility.pixels.size(); ++i)
        different += std::abs(result.visibility.pixels[i] - first.visibility.pixels[i]) > 0.01f;
      // Ranges are rounded otherwise on the device.
      EXPECT_LE(different, result.visibility.pixels.size() / 2000) << layout;
      EXPECT_LT(visibility_error(result.visibility, truth, result.judged).rms, 0.15) << layout;
    }
  }
}

/// The avenue's picture after one from another camera.
RenderResult after(const Camera& earlier, const std::string& layout) {
  RenderRequest asked =
      request(std::make_shared<const Scene>(avenue()), "shadow-map", {{"layout", layout}}, picture);
  asked.earlier_cameras = {earlier};
  return renderer().render(asked);
}

TEST(Tiles, ranked_a_frame_late_follow_the_camera_before) {
  const Scene scene = avenue();
  const RenderResult alone = draw(scene, "shadow-map", {{"layout", "iasm-delayed"}}, picture);
  // One that looks back, where other tiles matter.
  Camera other = scene.cameras[0];
  other.target = other.position + glm::dvec3(18.0, -1.0, 6.0);
  const RenderResult jumped = after(other, "iasm-delayed");
  EXPECT_NE(sizes_of(jumped), sizes_of(alone));
  EXPECT_EQ(sizes_of(after(scene.cameras[0], "iasm-delayed")), sizes_of(alone));
  // What the render before kept is gone.
  const RenderResult again = draw(scene, "shadow-map", {{"layout", "iasm-delayed"}}, picture);
  EXPECT_TRUE(same(alone.visibility, again.visibility));
  for (const char* layout : {"iasm", "iasm-gpu"}) {
    const RenderResult own = draw(scene, "shadow-map", {{"layout", layout}}, picture);
    EXPECT_TRUE(same(after(other, layout).visibility, own.visibility)) << layout;
  }
  // Coarse for a frame, but no worse than a map of few texels.
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  EXPECT_LT(visibility_error(jumped.visibility, truth, jumped.judged).rms, 0.3);
}

TEST(Tiles, give_the_same_picture_again) {
  const Scene scene = avenue();
  for (const std::string& layout : tile_layouts()) {
    const RenderResult first = draw(scene, "pcf-bilinear-3x3", {{"layout", layout}}, picture);
    const RenderResult again = draw(scene, "pcf-bilinear-3x3", {{"layout", layout}}, picture);
    EXPECT_TRUE(same(first.visibility, again.visibility)) << layout;
  }
}

TEST(Tiles, serve_every_bias_that_needs_one_surface_as_well_as_one_view_does) {
  const Scene scene = avenue();
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  const auto declared = techniques::resolve("pcf").technique->parameters;
  const auto strategies =
      std::find_if(declared.begin(), declared.end(),
                   [](const Parameter& parameter) { return parameter.name == "bias_strategy"; });
  ASSERT_NE(strategies, declared.end());
  std::size_t refused = 0;
  for (const std::string& strategy : strategies->choices) {
    SCOPED_TRACE(strategy);
    try {
      // A constant bias leaves steep walls striped on any map.
      const auto error = [&](const std::string& layout) {
        const RenderResult result =
            draw(scene, "pcf-bilinear",
                 {{"layout", layout}, {"bias_strategy", strategy}, {"map_size", 1024}}, picture);
        return visibility_error(result.visibility, truth, result.judged).rms;
      };
      EXPECT_LT(error("iasm"), 1.1 * error("single"));
    } catch (const Error& error) {
      EXPECT_EQ(error.code, "unsupported");
      EXPECT_EQ(error.field, "bias_strategy");
      ++refused;
    }
  }
  EXPECT_EQ(refused, 4u);  // second-depth, midpoint, dual-depth, auto
}

TEST(Tiles, keep_their_texels_in_proportion_within_the_buffer) {
  const RenderResult result =
      draw(avenue(), "shadow-map", {{"layout", "iasm"}, {"tile_sizes", "proportional"}}, picture);
  const auto sizes = sizes_of(result);
  const auto importance = importance_of(result);
  ASSERT_EQ(sizes.size(), 16u);
  double texels = 0.0;
  const double all = std::accumulate(importance.begin(), importance.end(), 0.0);
  for (std::size_t i = 0; i < 16; ++i) {
    texels += sizes[i] * sizes[i];
    const double side = std::sqrt(importance[i] / all * 1715200.0);
    EXPECT_NEAR(sizes[i], std::clamp(side, 1.0, 1024.0), 2.0) << i;
  }
  EXPECT_LE(texels, 1715200.0);
  EXPECT_EQ(draw(avenue(), "shadow-map", {{"layout", "iasm-gpu"}, {"tile_sizes", "proportional"}},
                 picture)
                .non_finite_pixels,
            0u);
}

TEST(Tiles, begin_their_range_where_asked) {
  const Scene scene = avenue();
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  for (const char* range : {"visible", "casters", "common"})
    for (const char* bits : {"16", "32"}) {
      const RenderResult result =
          draw(scene, "pcf-bilinear",
               {{"layout", "iasm"}, {"tile_range", range}, {"depth_bits", bits}}, picture);
      EXPECT_LT(visibility_error(result.visibility, truth, result.judged).rms, 0.1)
          << range << ", " << bits;
    }
}

TEST(Tiles, refuse_a_square_that_no_float_can_cut) {
  try {
    draw(avenue(), "shadow-map", {{"layout", "iasm"}, {"tile_radius", 1e-9}}, 16);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "bad_value");
    EXPECT_EQ(error.field, "tile_radius");
  }
}

TEST(Tiles, beyond_a_square_of_ones_own_is_light) {
  // Six metres around a camera that looks along the avenue: its far shadows are gone.
  const Scene scene = avenue();
  const RenderResult whole = draw(scene, "shadow-map", {{"layout", "iasm"}}, picture);
  const RenderResult small =
      draw(scene, "shadow-map", {{"layout", "iasm"}, {"tile_radius", 3.0}}, picture);
  std::size_t far_shadows = 0, lost = 0;
  for (std::uint32_t y = 0; y < picture / 2 + 12; ++y)
    for (std::uint32_t x = 0; x < picture; ++x)
      if (whole.judged.at(x, y, 0) > 0.5f && whole.visibility.at(x, y, 0) == 0.0f) {
        ++far_shadows;
        lost += small.visibility.at(x, y, 0) == 1.0f;
      }
  EXPECT_GT(far_shadows, 20u);
  EXPECT_EQ(lost, far_shadows);
}

TEST(Tiles, filter_what_is_encoded_as_well_as_one_view_does) {
  const Scene scene = avenue();
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  const std::pair<const char*, ParameterValues> filters[] = {
      {"vsm", {}},
      {"evsm", {}},
      {"msm", {}},
      {"msm", {{"precision", "unorm16"}, {"moment_bias", 6e-5}}},
      {"esm", {}},
      {"esm", {{"filtering", "logarithmic"}, {"mips", false}, {"c", 300.0}}},
      {"esm", {{"fallback", "z-max"}, {"blur_filter", "box"}}}};
  for (const auto& [technique, own] : filters) {
    SCOPED_TRACE(technique);
    const auto error = [&](const std::string& layout) {
      ParameterValues values = own;
      values.emplace("layout", layout);
      values.emplace("map_size", 1024);
      const RenderResult result = draw(scene, technique, values, picture);
      return visibility_error(result.visibility, truth, result.judged).rms;
    };
    for (const char* layout : {"iasm", "iasm-gpu"}) EXPECT_LT(error(layout), error("single"));
  }
}

TEST(Tiles, refuse_filters_that_need_an_image) {
  try {
    draw(avenue(), "pcf", {{"layout", "iasm"}, {"filter", "hardware-bilinear"}}, 16);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "unsupported");
    EXPECT_EQ(error.field, "layout");
    EXPECT_THAT(error.what(), testing::HasSubstr("buffer"));
  }
}

TEST(Tiles, that_show_nothing_are_not_drawn_unless_a_filter_reads_over_borders) {
  // A person looks along the ground: tiles behind and beside show nothing, and one mesh lies in
  // all.
  Scene scene = plain({0, 2, -50}, {0, 1, -70});
  scene.cameras[0].vertical_fov = 12.0;
  scene.lights.push_back(slanted_sun({0.1, -1.0, 0.1}));
  const auto drawn = [&](const char* technique) {
    const auto triangles =
        noted(draw(scene, technique, {{"layout", "iasm"}, {"tile_radius", 15.0}}, picture),
              "the views of its map draw triangles: ", ";");
    return std::count_if(triangles.begin(), triangles.end(), [](double n) { return n > 0.0; });
  };
  EXPECT_LT(drawn("shadow-map"), 13);
  EXPECT_EQ(drawn("pcf-bilinear-3x3"), 16);
}

}  // namespace tiles_test
}  // namespace penumbra::tests
