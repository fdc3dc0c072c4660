#pragma once

#include <array>
#include <span>

#include "renderer/frame/prepare_context.h"
#include "renderer/shadow_maps/layout.h"
#include "renderer/shadow_maps/views/seen_samples.h"

/// Irregular adaptive shadow maps (Alecu 2014, 3): a square of the plane across the light's
/// direction is cut into 4 x 4 tiles of one width, which get more texels the more of the picture
/// they matter to. All texels stand in one buffer.
namespace penumbra::shadow_maps {

/// A layout of tiles that are ranked in this way.
Layout tile_layout(const std::string& id, const std::string& meaning, TileRanking ranking);

/// Log2 of what an importance of 1 adds to a tile's sum, so that the sum of `samples` pixels of the
/// greatest importance, 1 + gain, stays below 2^32.
int importance_scale(std::uint64_t samples, double gain);

/// Rank of every tile by importance, greatest first; of equal ones the first comes first.
std::array<std::uint32_t, shader::tile_count> tile_ranks(
    std::span<const std::uint32_t, shader::tile_count> importance);

/// The texels of a light's tiles, and how these are ranked. One for each light of a render: it
/// keeps what the last frame saw.
class Tiles {
 public:
  static void require(const TechniqueInput& input, TileRanking ranking, Requirements& needs);

  /// Ranks tiles that were placed and have the ranges that do not follow what is seen; `samples`
  /// are this frame's. Returns constants of the map, which the device may still have to write.
  vulkan::BufferRange rank(PrepareContext& context, std::vector<shader::MapView> tiles,
                           const MapUse& use, SeenSamples& samples);

  /// Draws casters into all tiles. Returns what each draws.
  std::vector<DrawnCasters> draw(PrepareContext& context, const vulkan::BufferRange& map) const;

  void bind(vulkan::Bindings& bindings) const;

 private:
  using Sums = std::array<shader::TileSums, shader::tile_count>;
  void allocate(PrepareContext& context, TileRanking ranking);
  void measure(PrepareContext& context, const shader::MapData& placed,
               const vulkan::BufferRange& rules, SeenSamples& samples);
  Sums read() const;
  Sums sums_of_previous(PrepareContext& context, const std::function<void()>& measure_now);
  vulkan::BufferRange rank_on_device(PrepareContext& context, const shader::MapData& placed,
                                     const vulkan::BufferRange& rules);

  vulkan::Buffer texels_;
  vulkan::Buffer sums_;
  vulkan::Buffer ranked_;  ///< constants of the map, where the device writes them
  std::vector<shader::MapView> placed_;
  std::vector<bool> drawn_;  ///< tiles that are not known to be empty
  Sums previous_{};          ///< what the frame before this one saw
  bool measured_ = false;    ///< sums_ hold some frame's
  std::uint32_t frame_ = 0;  ///< that sums_ are of, and its camera
  glm::dmat4 camera_{0.0};
};

}  // namespace penumbra::shadow_maps
