#include "scenes/generators/textures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <map>

#include "renderer/error.h"
#include "scenes/generators/noise.h"

namespace penumbra::scenes {
namespace {

/// sRGB-encoded colour, 0..1, of a point of the unit square.
using Painter = std::function<glm::dvec3(double u, double v)>;
using PainterMaker = Painter (*)(std::uint32_t seed);

glm::dvec3 rgb(int hex) {
  return glm::dvec3((hex >> 16) & 255, (hex >> 8) & 255, hex & 255) / 255.0;
}

/// Distance to the nearest whole number, 0..0.5.
double to_whole(double x) {
  return std::abs(x - std::floor(x + 0.5));
}

Painter concrete(std::uint32_t seed) {
  const FractalNoise clouds_noise(4, 4, 5, seed);
  const FractalNoise pores_noise(48, 48, 2, seed + 1);
  const FractalNoise stains_noise(3, 3, 4, seed + 2);
  const FractalNoise level_noise(160, 160, 1, seed + 3);
  return [=](double u, double v) {
    const double clouds = clouds_noise(u, v);
    const double pores = smooth_step(0.72, 0.9, pores_noise(u, v));
    const double stains = smooth_step(0.5, 0.75, stains_noise(u, v));
    const double level = 0.70 + 0.22 * (clouds - 0.5) + 0.05 * (level_noise(u, v) - 0.5);
    return glm::dvec3(1.0, 0.985, 0.955) * (level - 0.10 * pores - 0.07 * stains);
  };
}

/// Four boards that run along u, each with its own tone and end joint.
Painter wood(std::uint32_t seed) {
  const FractalNoise warp_noise(2, 8, 3, seed + 1);
  const FractalNoise fibres_noise(4, 96, 3, seed + 2);
  return [=](double u, double v) {
    const double row = std::floor(v * 4.0);
    const auto board = static_cast<std::int64_t>(row);
    const double shift = lattice(board, 7, seed);
    const double along = u + shift - std::floor(u + shift);
    const double tone = lattice(board, 11, seed);
    const double warp = warp_noise(u, v);
    const double fibres = fibres_noise(u, v);
    const double rings = to_whole(6.0 * v + 2.2 * warp + 3.0 * tone);
    const double mix = 0.30 + 0.35 * tone + 0.35 * (fibres - 0.5) + 0.35 * (rings - 0.25);
    glm::dvec3 color = glm::mix(rgb(0x8a5f38), rgb(0xc89a64), std::clamp(mix, 0.0, 1.0));
    const double gap = std::min(to_whole(v * 4.0) / 4.0, to_whole(along));
    return color * (0.45 + 0.55 * smooth_step(0.001, 0.005, gap));
  };
}

Painter asphalt(std::uint32_t seed) {
  const FractalNoise clouds_noise(3, 3, 4, seed);
  const FractalNoise stones_noise(96, 96, 2, seed + 1);
  return [=](double u, double v) {
    const double clouds = clouds_noise(u, v);
    const double stones = stones_noise(u, v);
    return glm::dvec3(0.98, 1.0, 1.03) * (0.46 + 0.08 * (clouds - 0.5) + 0.16 * (stones - 0.5));
  };
}

/// Sea from above: long swells that bend short waves, light crests and deep troughs.
Painter water(std::uint32_t seed) {
  const FractalNoise bend_noise(3, 4, 3, seed);
  const FractalNoise swell_noise(4, 9, 4, seed + 1);
  const FractalNoise ripple_noise(14, 30, 3, seed + 2);
  return [=](double u, double v) {
    const double bend = 0.06 * bend_noise(u, v);
    const double swell = swell_noise(u + bend, v + 2.0 * bend);
    const double ripple = ripple_noise(u - bend, v + bend);
    const double height = 0.62 * swell + 0.38 * ripple;
    glm::dvec3 color = glm::mix(rgb(0x1d5f78), rgb(0x3a8ea3), smooth_step(0.30, 0.70, height));
    return glm::mix(color, rgb(0xa9d6d8), 0.5 * smooth_step(0.58, 0.78, height));
  };
}

Painter sand(std::uint32_t seed) {
  const FractalNoise clouds_noise(3, 3, 5, seed);
  const FractalNoise bend_noise(3, 3, 3, seed + 1);
  const FractalNoise level_noise(170, 170, 1, seed);
  return [=](double u, double v) {
    const double clouds = clouds_noise(u, v);
    const double bend = bend_noise(u, v);
    const double ripples = to_whole(14.0 * v + 2.5 * bend);
    const double level =
        0.86 + 0.14 * (clouds - 0.5) + 0.06 * (ripples - 0.25) + 0.08 * (level_noise(u, v) - 0.5);
    return rgb(0xf0dcae) * level;
  };
}

/// Running bond, 4 bricks wide and 12 courses high: one repeat is about 1 m by 1 m.
Painter brick(std::uint32_t seed) {
  const FractalNoise rough_noise(24, 24, 3, seed + 1);
  return [=](double u, double v) {
    const double course = std::floor(v * 12.0);
    const auto row = static_cast<std::int64_t>(course);
    const double across = u * 4.0 + (row % 2 == 0 ? 0.0 : 0.5);
    const auto column = static_cast<std::int64_t>(std::floor(across)) % 4;
    const double edge = std::min(to_whole(across) / 4.0, to_whole(v * 12.0) / 12.0);
    const double tone = lattice(column, row, seed);
    const double rough = rough_noise(u, v);
    const glm::dvec3 clay =
        glm::mix(rgb(0x8e4a35), rgb(0xb9704f), 0.2 + 0.6 * tone) * (0.88 + 0.24 * (rough - 0.2));
    const glm::dvec3 mortar = rgb(0xb5aca0) * (0.85 + 0.2 * rough);
    return glm::mix(mortar, clay, smooth_step(0.005, 0.010, edge + 0.004 * (rough - 0.5)));
  };
}

/// Near white, so that the material's colour tells: worn paint with faint scratches and dirt.
Painter painted_metal(std::uint32_t seed) {
  const FractalNoise dirt_noise(4, 4, 5, seed);
  const FractalNoise streaks_noise(40, 3, 3, seed + 1);
  return [=](double u, double v) {
    const double dirt = dirt_noise(u, v);
    const double streaks = streaks_noise(u, v);
    return glm::dvec3(1.0, 0.99, 0.97) * (0.92 + 0.14 * (dirt - 0.5) + 0.08 * (streaks - 0.5));
  };
}

Painter cardboard(std::uint32_t seed) {
  const FractalNoise clouds_noise(4, 4, 4, seed);
  const FractalNoise flutes_noise(64, 4, 2, seed + 1);
  return [=](double u, double v) {
    const double clouds = clouds_noise(u, v);
    const double flutes = flutes_noise(u, v);
    const double fold = smooth_step(0.004, 0.012, to_whole(v));
    return rgb(0xc29a6b) * (0.92 + 0.14 * (clouds - 0.5) + 0.08 * (flutes - 0.5)) *
           (0.85 + 0.15 * fold);
  };
}

/// Roof or wall sheet whose ribs run along v.
Painter corrugated(std::uint32_t seed) {
  const FractalNoise dirt_noise(6, 2, 5, seed);
  const FractalNoise rust_noise(5, 3, 5, seed + 1);
  return [=](double u, double v) {
    const double rib = to_whole(u * 8.0) * 2.0;
    const double dirt = dirt_noise(u, v);
    const double rust = smooth_step(0.60, 0.80, rust_noise(u, v));
    const glm::dvec3 sheet =
        rgb(0xbcc4c8) * (0.74 + 0.24 * smooth_step(0.15, 0.85, rib)) * (0.94 + 0.2 * (dirt - 0.5));
    return glm::mix(sheet, rgb(0x96644a), 0.5 * rust);
  };
}

Painter bark(std::uint32_t seed) {
  const FractalNoise plates_noise(6, 14, 4, seed);
  const FractalNoise rings_noise(8, 4, 2, seed + 1);
  return [=](double u, double v) {
    const double plates = plates_noise(u, v);
    const double rings = to_whole(10.0 * v + 0.6 * rings_noise(u, v));
    return glm::mix(rgb(0x6b5238), rgb(0xa98c68),
                    std::clamp(0.2 + plates * 0.7 + rings * 0.3, 0.0, 1.0));
  };
}

Painter leaf(std::uint32_t seed) {
  const FractalNoise tone_noise(6, 6, 3, seed);
  return [=](double u, double v) {
    const double veins = to_whole(12.0 * u + 4.0 * std::abs(v - 0.5));
    const double tone = tone_noise(u, v);
    return glm::mix(rgb(0x3f6b2c), rgb(0x7fa548),
                    std::clamp(0.1 + 0.7 * tone + 0.5 * veins, 0.0, 1.0));
  };
}

Painter grass(std::uint32_t seed) {
  const FractalNoise patches_noise(4, 4, 5, seed);
  const FractalNoise blades_noise(90, 60, 2, seed + 1);
  return [=](double u, double v) {
    const double patches = patches_noise(u, v);
    const double blades = blades_noise(u, v);
    return glm::mix(rgb(0x4c6b2f), rgb(0x93a85a),
                    std::clamp(0.65 * patches + 0.5 * blades - 0.05, 0.0, 1.0));
  };
}

Painter rock(std::uint32_t seed) {
  const FractalNoise layers_noise(5, 12, 5, seed);
  const FractalNoise cracks_noise(6, 6, 4, seed + 1);
  return [=](double u, double v) {
    const double layers = layers_noise(u, v);
    const double cracks = smooth_step(0.0, 0.06, std::abs(cracks_noise(u, v) - 0.5));
    return glm::mix(rgb(0x6d675f), rgb(0xb3aa9b), layers) * (0.75 + 0.25 * cracks);
  };
}

Painter plaster(std::uint32_t seed) {
  const FractalNoise clouds_noise(5, 5, 5, seed);
  return [=](double u, double v) {
    const double clouds = clouds_noise(u, v);
    return rgb(0xe8e2d4) * (0.96 + 0.10 * (clouds - 0.5));
  };
}

/// Four by four square tiles with joints; the tiles differ a little in tone.
Painter tiles(std::uint32_t seed) {
  const FractalNoise clouds_noise(8, 8, 5, seed);
  return [=](double u, double v) {
    const auto x = static_cast<std::int64_t>(std::floor(u * 4.0)) % 4;
    const auto y = static_cast<std::int64_t>(std::floor(v * 4.0)) % 4;
    const double joint = std::min(to_whole(u * 4.0), to_whole(v * 4.0));
    const double clouds = clouds_noise(u, v);
    const double level = 0.80 + 0.06 * (lattice(x, y, seed) - 0.5) + 0.14 * (clouds - 0.5);
    return glm::dvec3(1.0, 0.98, 0.94) * level * (0.72 + 0.28 * smooth_step(0.008, 0.022, joint));
  };
}

const std::map<std::string, PainterMaker>& painters() {
  static const std::map<std::string, PainterMaker> table = {
      {"asphalt", asphalt},     {"bark", bark},         {"brick", brick},
      {"cardboard", cardboard}, {"concrete", concrete}, {"corrugated", corrugated},
      {"grass", grass},         {"leaf", leaf},         {"painted_metal", painted_metal},
      {"plaster", plaster},     {"rock", rock},         {"sand", sand},
      {"tiles", tiles},         {"water", water},       {"wood", wood}};
  return table;
}

}  // namespace

const std::vector<std::string>& texture_generators() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& [name, painter] : painters()) list.push_back(name);
    return list;
  }();
  return names;
}

Texture generate_texture(const std::string& generator, std::uint32_t size, std::uint32_t seed) {
  const auto painter = painters().find(generator);
  if (painter == painters().end()) {
    std::string names;
    for (const std::string& name : texture_generators())
      names += (names.empty() ? "" : ", ") + name;
    throw bad_value("generator", "no texture generator '" + generator + "'; there are: " + names);
  }
  if (size < 1 || size > 4096)
    throw bad_value("size", "a texture's size must be in 1..4096 texels");
  const Painter paint = painter->second(seed);
  Texture texture;
  texture.name = generator;
  texture.width = texture.height = size;
  texture.rgba.reserve(std::size_t{size} * size * 4);
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const glm::dvec3 color = paint((x + 0.5) / size, (y + 0.5) / size);
      for (int c = 0; c < 3; ++c)
        texture.rgba.push_back(
            static_cast<std::uint8_t>(std::clamp(color[c], 0.0, 1.0) * 255.0 + 0.5));
      texture.rgba.push_back(255);
    }
  return texture;
}

}  // namespace penumbra::scenes
