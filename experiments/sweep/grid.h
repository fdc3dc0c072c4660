#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/engine/engine.h"

/// The combinations of van Sambeek 2007, 4.1.1, and table 4.1.
namespace penumbra::experiments {

inline constexpr std::array<int, 7> swept_objects{1, 5, 10, 25, 50, 100, 200};
inline constexpr std::array<int, 3> swept_triangles{100, 1600, 10000};  ///< he left the last out
inline constexpr int swept_lights = 3;                                  ///< 1 to 3
std::vector<std::uint32_t> swept_sizes();  ///< 25, 50, and 100 to 1200 in hundreds

/// Most objects that a sweep scene can have.
inline constexpr int most_objects = 1000;

/// What sweep:OxTxL names.
struct SweepScene {
  int objects = 0;
  int triangles = 0;
  int lights = 0;
};
std::optional<SweepScene> read_sweep_scene(const std::string& name);
std::string sweep_scene(const SweepScene& scene);

/// Scenes that patterns name, each once: * and ? match among the sweep's scenes (all triangle
/// counts) and the built-in ones; what has neither is a scene's name. Throws not_found (field
/// scenes) for a pattern that matches nothing.
std::vector<std::string> matching_scenes(const std::vector<std::string>& patterns);

/// A row of table 4.1: objects that stay under 50 ms at 1200 x 1200 under three lights.
struct PublishedLimit {
  std::string label;      ///< his
  std::string technique;  ///< as read_technique takes it
  std::string bottleneck;
  /// Low and high poly; none where he gives none, since all his scenes stayed under 50 ms.
  std::array<std::optional<double>, 2> objects;
};
const std::vector<PublishedLimit>& table_4_1();

}  // namespace penumbra::experiments
