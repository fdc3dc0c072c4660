#include "techniques/occluder-textures/picture.h"

#include <algorithm>
#include <cmath>

namespace penumbra::techniques::occluder_textures {
namespace {

/// Texels of a row whose centres lie in [from, to).
std::pair<int, int> centers_between(double from, double to, int size) {
  const auto first = [size](double x) {
    return static_cast<int>(std::clamp(std::ceil(x - 0.5), 0.0, static_cast<double>(size)));
  };
  return {first(from), first(to)};
}

}  // namespace

Bounds Rectangle::bounds() const {
  Bounds box;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5}) box.add(center + x * size.x * right + y * size.y * up);
  return box;
}

double Picture::filled() const {
  const auto count =
      std::count_if(texels_.begin(), texels_.end(), [](std::uint8_t texel) { return texel > 0; });
  return static_cast<double>(count) / static_cast<double>(texels_.size());
}

glm::dvec2 Picture::texel_of(const Rectangle& rectangle, const glm::dvec3& point) const {
  const glm::dvec3 offset = point - rectangle.center;
  const glm::dvec2 place(glm::dot(offset, rectangle.right), glm::dot(offset, rectangle.up));
  return (place / rectangle.size + 0.5) * static_cast<double>(size_);
}

void Picture::add_silhouette(const Rectangle& rectangle, const Body& body) {
  const int size = static_cast<int>(size_);
  for (const Triangle& triangle : body.triangles) {
    std::array<glm::dvec2, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = texel_of(rectangle, triangle[k]);
    const auto [first, last] = centers_between(std::min({p[0].y, p[1].y, p[2].y}),
                                               std::max({p[0].y, p[1].y, p[2].y}), size);
    for (int row = first; row < last; ++row) {
      // A row crosses two sides of the triangle.
      const double y = row + 0.5;
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 a = p[k], b = p[(k + 1) % 3];
        if ((a.y <= y) == (b.y <= y)) continue;
        const double x = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
        low = std::min(low, x);
        high = std::max(high, x);
      }
      if (low > high) continue;
      const auto [start, stop] = centers_between(low, high, size);
      std::fill(texels_.begin() + row * size + start, texels_.begin() + row * size + stop, 255);
    }
  }
}

void Picture::add_section(const Rectangle& rectangle, const Body& body) {
  const int size = static_cast<int>(size_);
  const glm::dvec3 normal = rectangle.normal();
  std::vector<std::vector<double>> crossings(size_);
  for (const Triangle& triangle : body.triangles) {
    std::array<double, 3> height;
    for (std::size_t k = 0; k < 3; ++k)
      height[k] = glm::dot(triangle[k] - rectangle.center, normal);
    std::vector<glm::dvec2> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t n = (k + 1) % 3;
      if ((height[k] <= 0.0) == (height[n] <= 0.0)) continue;
      const double share = height[k] / (height[k] - height[n]);
      ends.push_back(texel_of(rectangle, triangle[k] + share * (triangle[n] - triangle[k])));
    }
    if (ends.size() != 2) continue;
    const glm::dvec2 a = ends[0].y <= ends[1].y ? ends[0] : ends[1];
    const glm::dvec2 b = ends[0].y <= ends[1].y ? ends[1] : ends[0];
    const auto [first, last] = centers_between(a.y, b.y, size);
    for (int row = first; row < last; ++row)
      crossings[static_cast<std::size_t>(row)].push_back(a.x + (b.x - a.x) * (row + 0.5 - a.y) /
                                                                   (b.y - a.y));
  }
  for (int row = 0; row < size; ++row) {
    auto& xs = crossings[static_cast<std::size_t>(row)];
    std::sort(xs.begin(), xs.end());
    for (std::size_t i = 0; i + 1 < xs.size(); i += 2) {
      const auto [start, stop] = centers_between(xs[i], xs[i + 1], size);
      std::fill(texels_.begin() + row * size + start, texels_.begin() + row * size + stop, 255);
    }
  }
}

void Picture::extend_within(const Picture& allowed, std::uint32_t reach) {
  const int size = static_cast<int>(size_);
  for (std::uint32_t step = 0; step < reach; ++step) {
    const std::vector<std::uint8_t> before = texels_;
    const auto filled = [&](int x, int y) {
      return x >= 0 && y >= 0 && x < size && y < size &&
             before[static_cast<std::size_t>(y * size + x)] > 0;
    };
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const auto at = static_cast<std::size_t>(y * size + x);
        if (before[at] == 0 && allowed.texels_[at] > 0 &&
            (filled(x - 1, y) || filled(x + 1, y) || filled(x, y - 1) || filled(x, y + 1)))
          texels_[at] = 255;
      }
  }
}

}  // namespace penumbra::techniques::occluder_textures
