#include "scenes/generators/silhouette.h"

#include <algorithm>
#include <cmath>

namespace penumbra::scenes {
namespace {

/// Twice the signed area of a triangle.
double area_of(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Blackens texels whose middles lie in a triangle; corners in texels, y downwards.
void fill(Texture& texture, const glm::dvec2 (&corners)[3]) {
  const glm::dvec2 low = glm::min(corners[0], glm::min(corners[1], corners[2]));
  const glm::dvec2 high = glm::max(corners[0], glm::max(corners[1], corners[2]));
  const auto first = [](double value) { return std::max(0, static_cast<int>(std::floor(value))); };
  const auto end = [](double value, std::uint32_t size) {
    return std::min(static_cast<int>(size), static_cast<int>(std::ceil(value)));
  };
  for (int y = first(low.y); y < end(high.y, texture.height); ++y)
    for (int x = first(low.x); x < end(high.x, texture.width); ++x) {
      const glm::dvec2 middle(x + 0.5, y + 0.5);
      const double a = area_of(corners[0], corners[1], middle);
      const double b = area_of(corners[1], corners[2], middle);
      const double c = area_of(corners[2], corners[0], middle);
      if (std::min(a, std::min(b, c)) < 0.0 && std::max(a, std::max(b, c)) > 0.0) continue;
      const std::size_t texel =
          static_cast<std::size_t>(y) * texture.width + static_cast<std::size_t>(x);
      std::fill_n(texture.rgba.begin() + static_cast<std::ptrdiff_t>(4 * texel), 3, 0);
    }
}

}  // namespace

Texture silhouette_texture(const std::string& name, const Mesh& mesh, const ShadowPlane& plane,
                           std::uint32_t size) {
  Texture texture;
  texture.name = name;
  texture.width = texture.height = size;
  texture.rgba.assign(std::size_t{size} * size * 4, 255);
  const auto on_texture = [&](std::uint32_t index) {
    const glm::dvec3 from_center = glm::dvec3(mesh.positions[index]) - plane.center;
    return glm::dvec2(0.5 + glm::dot(from_center, plane.right) / plane.size.x,
                      0.5 - glm::dot(from_center, plane.up) / plane.size.y) *
           static_cast<double>(size);
  };
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    fill(texture, {on_texture(mesh.indices[i]), on_texture(mesh.indices[i + 1]),
                   on_texture(mesh.indices[i + 2])});
  return texture;
}

ShadowPlane moved_plane(ShadowPlane plane, const glm::dmat4& motion) {
  plane.center = glm::dvec3(motion * glm::dvec4(plane.center, 1.0));
  plane.right = glm::normalize(glm::dvec3(motion * glm::dvec4(plane.right, 0.0)));
  plane.up = glm::normalize(glm::dvec3(motion * glm::dvec4(plane.up, 0.0)));
  return plane;
}

}  // namespace penumbra::scenes
