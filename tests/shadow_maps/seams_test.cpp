// Borders between the views of a layout, widths of penumbrae there and under warps, and turns of
// camera and light all the way round.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "avenue.h"
#include "drawing.h"
#include "hard_truth.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra::tests {
namespace seams_test {

constexpr std::uint32_t picture = 160;  // pixels a side
constexpr double pi = 3.14159265358979;

Image8 views_of(const Scene& scene, const std::string& technique,
                const ParameterValues& parameters) {
  RenderRequest asked =
      request(std::make_shared<const Scene>(scene), technique, parameters, picture);
  asked.diagnostic = "views";
  return renderer().render(asked).diagnostic;
}

/// Rows to the nearest change of view along a column, up or down: views lie behind each other.
std::vector<std::uint32_t> rows_to_border(const Image8& views) {
  // A colour's hue tells the view; shadow darkens it.
  const auto hue = [&](std::uint32_t x, std::uint32_t y) {
    const double r = views.at(x, y, 0), g = views.at(x, y, 1), b = views.at(x, y, 2);
    const double sum = std::max(r + g + b, 1.0);
    return glm::dvec2(r / sum, g / sum);
  };
  const auto told = [&](std::uint32_t x, std::uint32_t y) {
    return views.at(x, y, 0) + views.at(x, y, 1) + views.at(x, y, 2) > 0;
  };
  // Over some rows: where views are mixed, colours change little from one to the next.
  constexpr std::uint32_t reach = 2;
  std::vector<std::uint32_t> rows(std::size_t{picture} * picture, picture);
  for (std::uint32_t x = 0; x < picture; ++x)
    for (std::uint32_t y = reach; y + reach < picture; ++y) {
      if (!told(x, y - reach) || !told(x, y + reach)) continue;
      if (glm::length(hue(x, y + reach) - hue(x, y - reach)) < 0.03) continue;
      for (std::uint32_t v = 0; v < picture; ++v) {
        const std::uint32_t away = v >= y ? v - y : y - v;
        rows[v * picture + x] = std::min(rows[v * picture + x], away);
      }
    }
  return rows;
}

/// Beams across the way, all over a plain: what is near a border looks like what is not.
Scene beams() {
  Scene scene = plain();
  for (int i = 0; i < 40; ++i) {
    const double x = -20.0 + i;
    add_box(scene, {x, 2.0, -110}, {x + 0.45, 2.2, 8});
  }
  scene.cameras[0].position = {0, 6, 5};
  scene.cameras[0].target = {0, 0, -16};
  scene.lights.push_back(slanted_sun({0.5, -1.0, 0.1}));
  return scene;
}

TEST(Seams, errors_at_borders_of_views_are_those_beside_them) {
  const Scene scene = beams();
  const ImageF truth = HardTruth(scene).visibility("", picture, picture);
  std::size_t layouts_with_borders = 0;
  for (const std::string& layout : sun_layouts()) {
    double hard = 0.0;
    for (const char* technique : {"shadow-map", "pcf-bilinear-3x3", "vsm", "evsm"}) {
      if (!draws_sun(technique, layout)) continue;
      SCOPED_TRACE(technique + (" on " + layout));
      const ParameterValues parameters{{"layout", layout}, {"map_size", std::int64_t{512}}};
      const auto rows = rows_to_border(views_of(scene, technique, parameters));
      const RenderResult result = draw(scene, technique, parameters, picture);
      double at = 0.0, beside = 0.0, at_count = 0.0, beside_count = 0.0;
      for (std::uint32_t y = 0; y < picture; ++y)
        for (std::uint32_t x = 0; x < picture; ++x) {
          if (result.judged.at(x, y, 0) < 0.5f) continue;
          const std::uint32_t away = rows[y * picture + x];
          const double error =
              std::pow(double{result.visibility.at(x, y, 0)} - double{truth.at(x, y, 0)}, 2.0);
          if (away <= 2) {
            at += error;
            at_count += 1.0;
          } else if (away <= 12) {
            beside += error;
            beside_count += 1.0;
          }
        }
      if (at_count < 100.0) continue;  // one view
      ++layouts_with_borders;
      EXPECT_GT(beside / beside_count, 1e-4) << "nothing to compare with";
      if (hard == 0.0) hard = std::sqrt(beside / beside_count);
      // Tiles mix nothing at borders: a filter that is better than comparisons beside them need not
      // be there.
      const double elsewhere = std::max(std::sqrt(beside / beside_count), hard);
      EXPECT_LT(std::sqrt(at / at_count), 1.5 * elsewhere);
    }
  }
  EXPECT_GE(layouts_with_borders, 4u);
}

/// Half of the ground under a plate 4 m over it whose edge runs along the view, under a sun of 3
/// degrees overhead: the penumbra is 2 x 4 m x tan(3 degrees) wide.
Scene roof_along_the_view() {
  Scene scene = plain();
  add_plate(scene, {-30, -60}, {0, 8}, 4.0);
  Light light = sun();
  light.extent = {.kind = ExtentKind::disc, .radius = 3.0};
  scene.lights.push_back(light);
  scene.cameras[0].position = {0, 2, 2};
  scene.cameras[0].target = {0, 0, -6};
  return scene;
}

/// How far from the penumbra's middle a pixel lies, in its half widths, and what it sees.
struct Sample {
  double across, lit;
  std::uint32_t rows;  ///< to a border of views
};

std::vector<Sample> penumbra_samples(const Scene& scene, const std::string& layout) {
  // Slices that end near the camera, where the penumbra is many pixels wide.
  const ParameterValues parameters{{"layout", layout},
                                   {"map_size", std::int64_t{1024}},
                                   {"taps", std::int64_t{256}},
                                   {"split_lambda", 0.95}};
  const RenderResult result = draw(scene, "pcss", parameters, picture);
  const auto rows = rows_to_border(views_of(scene, "pcss", parameters));
  const Camera& camera = scene.cameras[0];
  const double half_width = 4.0 * std::tan(glm::radians(3.0));
  const double tangent = std::tan(glm::radians(0.5 * camera.vertical_fov));
  const glm::dvec3 ahead = glm::normalize(camera.target - camera.position);
  const glm::dvec3 up = glm::normalize(glm::cross(glm::cross(ahead, {0, 1, 0}), ahead));
  std::vector<Sample> samples;
  for (std::uint32_t y = 0; y < picture; ++y)
    for (std::uint32_t x = 0; x < picture; ++x) {
      const glm::dvec3 ray = ahead + glm::dvec3(tangent * (2.0 * (x + 0.5) / picture - 1.0), 0, 0) +
                             tangent * (1.0 - 2.0 * (y + 0.5) / picture) * up;
      if (ray.y > -0.1) continue;
      const glm::dvec3 place = camera.position - ray * (camera.position.y / ray.y);
      if (std::abs(place.x) > 1.5 * half_width || place.z < -20.0) continue;
      samples.push_back(
          {place.x / half_width, double{result.visibility.at(x, y, 0)}, rows[y * picture + x]});
    }
  return samples;
}

/// Width over the true one for which the light of a disc fits best: 1/2 + (x sqrt(1 - x^2) +
/// asin x) / pi at x half widths.
double fitted_width(const std::vector<Sample>& samples) {
  double best = 0.0, least = 1e30;
  for (double width = 0.6; width < 1.6; width += 0.002) {
    double sum = 0.0;
    for (const Sample& sample : samples) {
      const double x = std::clamp(sample.across / width, -1.0, 1.0);
      const double lit = 0.5 + (x * std::sqrt(1.0 - x * x) + std::asin(x)) / pi;
      sum += (sample.lit - lit) * (sample.lit - lit);
    }
    if (sum < least) {
      least = sum;
      best = width;
    }
  }
  return best;
}

TEST(Seams, penumbrae_are_as_wide_at_borders_and_under_warps_as_on_one_view) {
  const Scene scene = roof_along_the_view();
  const double single = fitted_width(penumbra_samples(scene, "single"));
  EXPECT_NEAR(single, 1.0, 0.1);
  std::size_t borders = 0;
  for (const std::string& layout : sun_layouts()) {
    SCOPED_TRACE(layout);
    std::vector<Sample> samples = penumbra_samples(scene, layout);
    EXPECT_NEAR(fitted_width(samples) / single, 1.0, 0.05);
    std::erase_if(samples, [](const Sample& sample) { return sample.rows > 3; });
    if (samples.size() < 60) continue;
    ++borders;
    EXPECT_NEAR(fitted_width(samples) / single, 1.0, 0.05) << "at borders";
  }
  EXPECT_GE(borders, 1u);
}

/// Share of pixels in the middle of light or shadow, three from a border, that are the other way.
double swapped_share(const RenderResult& result, const ImageF& truth, std::uint32_t size) {
  constexpr std::uint32_t reach = 3;
  std::size_t inside = 0, swapped = 0;
  for (std::uint32_t y = reach; y + reach < size; ++y)
    for (std::uint32_t x = reach; x + reach < size; ++x) {
      bool even = true;
      for (std::uint32_t v = y - reach; even && v <= y + reach; ++v)
        for (std::uint32_t u = x - reach; even && u <= x + reach; ++u)
          even = result.judged.at(u, v, 0) > 0.5f && truth.at(u, v, 0) == truth.at(x, y, 0);
      inside += even;
      swapped += even && std::abs(result.visibility.at(x, y, 0) - truth.at(x, y, 0)) > 0.5f;
    }
  return inside == 0 ? 0.0 : static_cast<double>(swapped) / static_cast<double>(inside);
}

/// Draws every layout while the camera, or the light, turns once all the way round.
void turn(bool light_turns) {
  constexpr std::uint32_t size = 72;
  constexpr int steps = 24;
  Scene scene = avenue();
  scene.cameras[0].position = {0, 2, -20};
  for (int step = 0; step < steps; ++step) {
    const double angle = 2.0 * pi * step / steps;
    const glm::dvec3 ahead(std::sin(angle), 0.0, std::cos(angle));
    if (light_turns) {
      scene.lights[0].direction = glm::normalize(glm::dvec3(ahead.x, -0.7, ahead.z));
      scene.cameras[0].target = {0.0, 0.5, -40.0};
    } else {
      scene.cameras[0].target = scene.cameras[0].position + glm::dvec3(ahead.x, -0.1, ahead.z);
    }
    const ImageF truth = HardTruth(scene).visibility("", size, size);
    for (const std::string& layout : sun_layouts()) {
      SCOPED_TRACE(layout + ", " + std::to_string(15 * step) + " degrees");
      const RenderResult result =
          draw(scene, "pcf-bilinear", {{"layout", layout}, {"map_size", std::int64_t{1024}}}, size);
      EXPECT_EQ(result.non_finite_pixels, 0u);
      EXPECT_LT(swapped_share(result, truth, size), 0.004);
    }
  }
}

TEST(FullTurns, of_the_camera_leave_no_hole_and_swap_nothing) {
  turn(false);
}

TEST(FullTurns, of_the_light_leave_no_hole_and_swap_nothing) {
  turn(true);
}

}  // namespace seams_test
}  // namespace penumbra::tests
