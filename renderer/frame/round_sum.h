#pragma once

#include "renderer/image.h"

namespace penumbra {

/// The mean of a window's pictures over rounds of light points, each weighted by its points.
class RoundSum {
 public:
  /// `linear` has 4 channels; `visibility` and `judged` are empty or have a channel per light.
  void add(const ImageF& linear, const ImageF& visibility, const ImageF& judged,
           std::uint32_t points);
  void restart() { *this = {}; }

  ImageF linear() const { return mean(linear_, 1.0f / points_); }
  ImageF visibility() const;
  ImageF judged() const { return mean(judged_, 1.0f / points_); }

  template <class Archive>
  void visit(Archive& archive) {
    archive(linear_);
    archive(visibility_);
    archive(judged_);
    archive(points_);
  }

 private:
  static ImageF mean(ImageF sum, float scale);

  ImageF linear_;
  ImageF visibility_;  ///< times judged
  ImageF judged_;
  float points_ = 0.0f;
};

}  // namespace penumbra
