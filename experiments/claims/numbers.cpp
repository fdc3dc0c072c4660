// Claims about arithmetic, and about bytes, whose true numbers are known in closed form.
#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/claims/claim.h"
#include "experiments/claims/laboratory.h"

namespace penumbra::experiments::claims {
namespace {

Outcome q05(Laboratory&) {
  // Figure 2.6: five texels hold a caster at 11, four the surface behind at 53; the point is at 22.
  constexpr std::array<double, 9> depths{11, 11, 11, 11, 11, 53, 53, 53, 53};
  constexpr double point = 22.0;
  double sum = 0.0, nearer = 0.0;
  for (const double depth : depths) {
    sum += depth;
    nearer += depth < point ? 1.0 : 0.0;
  }
  const double of_means = sum / 9.0 < point ? 1.0 : 0.0;
  Outcome outcome;
  outcome.number("mean depth", sum / 9.0);
  outcome.number("shadow of the mean depth", of_means);
  outcome.number("mean of shadows", nearer / 9.0);
  outcome.part(of_means == 0.0);
  outcome.part(std::abs(nearer / 9.0 - 5.0 / 9.0) < 1e-12);
  return outcome;
}

/// Largest error of the k x k means that a table of 32-bit sums gives for a map that holds `value`
/// everywhere.
double error_of_table(std::size_t size, std::size_t k, float value) {
  std::vector<float> above(size + 1, 0.0f);
  std::vector<std::vector<float>> table{above};
  for (std::size_t y = 0; y < size; ++y) {
    std::vector<float> row(size + 1, 0.0f);
    float along = 0.0f;
    for (std::size_t x = 0; x < size; ++x) {
      along += value;
      row[x + 1] = above[x + 1] + along;
    }
    table.push_back(row);
    above = row;
  }
  double worst = 0.0;
  for (std::size_t y = k; y <= size; ++y)
    for (std::size_t x = k; x <= size; ++x) {
      const float sum = table[y][x] - table[y - k][x] - table[y][x - k] + table[y - k][x - k];
      worst = std::max(worst, std::abs(static_cast<double>(sum) / static_cast<double>(k * k) -
                                       static_cast<double>(value)));
    }
  return worst;
}

Outcome q43(Laboratory&) {
  constexpr std::size_t k = 5;
  Outcome outcome;
  for (const std::size_t size : {256u, 512u, 1024u, 2048u}) {
    // A depth that no power of two divides: sums must be rounded.
    const double measured = error_of_table(size, k, 0.7f);
    const double law = static_cast<double>(size * size) * std::ldexp(1.0, -24) / (k * k);
    outcome.number("error at " + std::to_string(size), measured);
    outcome.number("law at " + std::to_string(size), law);
    outcome.part(measured > law / 4.0 && measured < law * 4.0);
  }
  return outcome;
}

/// Where the ray from a point towards a light meets the plane y = 1; w of the light 0: a direction.
glm::dvec2 on_occluder(const glm::dvec3& point, const glm::dvec4& light) {
  const glm::dvec3 towards = glm::dvec3(light) - light.w * point;
  return glm::dvec2(point.x, point.z) +
         (1.0 - point.y) / towards.y * glm::dvec2(towards.x, towards.z);
}

/// Farthest that coordinates interpolated from the corners of a triangle of 8 m lie from those of
/// its points, metres.
double error_of_interpolation(const glm::dvec4& light) {
  const glm::dvec3 corners[] = {{-4.0, 0.0, -4.0}, {4.0, 0.0, -4.0}, {0.0, -1.0, 4.0}};
  double farthest = 0.0;
  constexpr int steps = 32;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const double a = double(i) / steps, b = double(j) / steps, c = 1.0 - a - b;
      const glm::dvec2 interpolated = a * on_occluder(corners[0], light) +
                                      b * on_occluder(corners[1], light) +
                                      c * on_occluder(corners[2], light);
      const glm::dvec3 point = a * corners[0] + b * corners[1] + c * corners[2];
      farthest = std::max(farthest, glm::length(interpolated - on_occluder(point, light)));
    }
  return farthest;
}

Outcome q49(Laboratory&) {
  const double sun = error_of_interpolation({0.3, 1.0, 0.2, 0.0});
  const double lamp = error_of_interpolation({0.6, 2.0, 0.4, 1.0});
  Outcome outcome;
  outcome.number("metres off, directional", sun);
  outcome.number("metres off, lamp", lamp);
  outcome.part(sun < 1e-12);
  outcome.part(lamp > 0.01);
  return outcome;
}

Outcome c23(Laboratory& lab) {
  const auto bytes = [&](const char* scene, const char* technique, std::uint32_t size) {
    return lab.value("memory_bytes", scene, technique, Truth::none, size);
  };
  // Maps take the same at any size of the picture; lights are counted at a small one.
  constexpr std::uint32_t small = 64;
  const char *one = "sweep:1x100x1", *eight = "sweep:1x100x8", *soft = "soft-shadow-volumes-2007";
  const double volumes = bytes(one, soft, 1200);
  const double growth = bytes(eight, soft, small) / bytes(one, soft, small);
  const double map = (bytes(eight, "shadow-map", small) - bytes(one, "shadow-map", small)) / 7.0;
  Outcome outcome;
  outcome.number("bytes of soft volumes", volumes);
  outcome.number("eight lights over one", growth);
  outcome.number("bytes of a light's map", map);
  outcome.number("maps that soft volumes equal", volumes / map);
  outcome.part(growth < 1.05);
  outcome.part(volumes > 10.0 * map && volumes < 11.0 * map);
  return outcome;
}

Outcome c24(Laboratory& lab) {
  const double map = lab.value("memory_bytes", "sweep:1x100x1", "shadow-map");
  const double moments = lab.value("memory_bytes", "sweep:1x100x1", "vsm-2007");
  Outcome outcome;
  outcome.number("bytes of the map", map);
  outcome.number("bytes of VSM", moments);
  outcome.number("ratio", moments / map);
  outcome.part(std::abs(moments / map - 1.0) < 0.05);
  return outcome;
}

}  // namespace

std::vector<Claim> number_claims() {
  return {
      {"Q49", "S2 4.1", "coordinates on the occluder may be computed at vertices (assumed)",
       "interpolated over a triangle they are exact for a directional light; over 1 cm off for a "
       "lamp",
       q49},
      {"Q05", "S0 fig. 2.6",
       "averaging depths before comparing is wrong, averaging comparisons gives 5/9 in shadow",
       "the mean depth's comparison says lit; the mean of comparisons is 5/9", q05},
      {"Q43", "S3 2.2.1", "a float table of w x h texels leaves 24 - log2(w h) bits",
       "the largest error of a 5x5 mean of a constant map is w h 2^-24 / 25 within a factor of 4, "
       "at 256; 512; 1024; 2048",
       q43},
      {"C23", "S0 4.2.4",
       "at 1200x1200 soft volumes take most memory (10.99 maps) unless there are more than 10 "
       "lights",
       "their bytes under eight lights are within 5% of those under one; they lie between 10 and "
       "11 maps",
       c23},
      {"C24", "S0 4.2.4", "VSM takes the memory of a shadow map", "ratio of bytes 1 within 5%",
       c24},
  };
}

}  // namespace penumbra::experiments::claims
