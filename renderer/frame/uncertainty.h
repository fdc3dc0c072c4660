#pragma once

#include <array>
#include <cstdint>

#include "renderer/image.h"
#include "renderer/shaders/shader_types.h"
#include "renderer/vulkan/commands.h"

namespace penumbra {

/// How far a picture may be off because its lights were sampled at finitely many points. Points
/// come in 16 independent sets (scrambles), each of which gives a picture of its own; what is shown
/// is their mean, and their spread tells its standard error.
class Uncertainty {
 public:
  static constexpr std::uint32_t scrambles = shader::scramble_count;
  /// Pixels of the largest picture that it is kept for: 16 pictures are held in memory.
  static constexpr std::uint64_t max_pixels = 1920 * 1200;

  /// `side`: samples along a side of a pixel.
  Uncertainty(vulkan::Device& device, vulkan::MemoryLedger& ledger, std::uint32_t width,
              std::uint32_t height, std::uint32_t side);

  /// Brightness that each scramble saw of the light at hand, by pixel: four in a layer.
  const vulkan::Image& sums() const { return sums_; }
  void clear_sums(vulkan::Commands& commands) const;

  /// Forgets what was added.
  void restart();
  /// How many points of a pixel were drawn in what is added next.
  void begin_round(std::uint32_t points);
  /// Reads the sums of a light that was drawn; `light_sum` holds its radiance by sample.
  void add_light(vulkan::Device& device, const vulkan::Image& light_sum);

  /// Standard error of Y (0.299 R + 0.587 G + 0.114 B of the encoded picture), in 0..255 and to
  /// first order, by pixel. `linear` is the picture before encoding, with `exposure` applied.
  ImageF standard_error(const ImageF& linear, float exposure, bool encodes) const;

  /// What was added so far, for `archive`'s operator() to read or write.
  template <class Archive>
  void visit(Archive& archive) {
    archive(deviations_);
    archive(points_);
  }

 private:
  /// By colour, of every scramble: what it saw more than the mean of all.
  using Deviations = std::array<std::array<float, scrambles>, 3>;

  std::uint32_t width_, height_, side_;
  vulkan::Image sums_;
  std::vector<Deviations> deviations_;  ///< sums over rounds, times each round's points
  float round_points_ = 1.0f;
  float points_ = 0.0f;  ///< of all rounds
};

/// Root of the mean square: of standard errors, what they add to rms_y.
double root_mean_square(const ImageF& image);

}  // namespace penumbra
