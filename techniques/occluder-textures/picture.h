#pragma once

#include "techniques/occluder-textures/bodies.h"

namespace penumbra::techniques::occluder_textures {

/// A rectangle in the world that an occluder texture lies on.
struct Rectangle {
  glm::dvec3 center{0.0};
  glm::dvec3 right{1.0, 0.0, 0.0};  ///< unit
  glm::dvec3 up{0.0, 1.0, 0.0};     ///< unit
  glm::dvec2 size{1.0};             ///< m along right and up

  glm::dvec3 normal() const { return glm::cross(right, up); }
  Bounds bounds() const;
};

/// Occlusion by texel: 0 lets light through, 255 stops it. Row 0 is the lowest along up.
class Picture {
 public:
  explicit Picture(std::uint32_t size) : size_(size), texels_(std::size_t{size} * size, 0) {}

  std::uint32_t size() const { return size_; }
  std::vector<std::uint8_t>& texels() { return texels_; }
  const std::vector<std::uint8_t>& texels() const { return texels_; }
  double filled() const;  ///< share of the texels that are above 0

  /// Fills texels whose centre the body covers, seen along the rectangle's normal.
  void add_silhouette(const Rectangle& rectangle, const Body& body);
  /// Fills texels whose centre lies inside the body, which must be closed.
  void add_section(const Rectangle& rectangle, const Body& body);
  /// Fills texels within `reach` texels (along both axes) of filled ones that `allowed` has filled.
  void extend_within(const Picture& allowed, std::uint32_t reach);

 private:
  glm::dvec2 texel_of(const Rectangle& rectangle, const glm::dvec3& point) const;
  std::uint32_t size_;
  std::vector<std::uint8_t> texels_;
};

}  // namespace penumbra::techniques::occluder_textures
