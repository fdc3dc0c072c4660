#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/image.h"
#include "renderer/scene/scene.h"

namespace penumbra::tests {

/// Visibility found by Embree, which shares no code with the renderer: the outside truth of map
/// techniques. Masks of materials are not seen.
class HardTruth {
 public:
  explicit HardTruth(const Scene& scene);
  ~HardTruth();
  HardTruth(const HardTruth&) = delete;
  HardTruth& operator=(const HardTruth&) = delete;

  /// A channel per light: 1 where the middle of the pixel sees the light's centre, otherwise 0.
  ImageF visibility(const std::string& camera, std::uint32_t width, std::uint32_t height) const;

  /// True if nothing that casts shadows stands between two points; both ends are drawn in a little.
  bool sees(const glm::dvec3& from, const glm::dvec3& to) const;

 private:
  const Scene& scene_;
  RTCDevice device_ = nullptr;
  RTCScene casters_ = nullptr;
  RTCScene surfaces_ = nullptr;
  double size_ = 1.0;  ///< of the scene's box, metres
};

}  // namespace penumbra::tests
