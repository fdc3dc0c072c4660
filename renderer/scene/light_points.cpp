#include "renderer/scene/light_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace penumbra {
namespace {

std::uint64_t mix(std::uint64_t x) {  // splitmix64's finaliser (Steele et al. 2014)
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ x >> 27) * 0x94d049bb133111ebull;
  return x ^ x >> 31;
}

/// Direction numbers of the first three Sobol' dimensions (Joe and Kuo 2008), most significant
/// first.
std::array<std::uint32_t, 32> direction_numbers(int dimension) {
  std::array<std::uint32_t, 32> v{};
  if (dimension == 0) {
    for (int i = 0; i < 32; ++i) v[static_cast<std::size_t>(i)] = 1u << (31 - i);
    return v;
  }
  // Primitive polynomials x + 1 and x^2 + x + 1, with m = {1} and {1, 3}.
  const int degree = dimension;
  const std::array<std::uint32_t, 2> m{1, 3};
  for (int i = 0; i < 32; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (i < degree) {
      v[k] = m[k] << (31 - i);
    } else {
      const auto d = static_cast<std::size_t>(degree);
      v[k] = v[k - d] ^ v[k - d] >> degree;
      if (degree == 2) v[k] ^= v[k - 1];
    }
  }
  return v;
}

std::uint32_t sobol(const std::array<std::uint32_t, 32>& v, std::uint32_t index) {
  std::uint32_t x = 0;
  for (std::size_t bit = 0; index != 0; index >>= 1, ++bit)
    if ((index & 1u) != 0) x ^= v[bit];
  return x;
}

/// Owen's nested uniform scrambling: each bit is flipped by a hash of the bits above it.
std::uint32_t scramble(std::uint32_t x, std::uint64_t seed) {
  std::uint32_t result = 0;
  for (int bit = 31; bit >= 0; --bit) {
    const std::uint64_t prefix = bit == 31 ? 0 : std::uint64_t{x} >> (bit + 1);
    const std::uint64_t flip = mix(seed ^ mix(prefix << 6 | static_cast<std::uint64_t>(bit))) & 1u;
    result |= ((x >> bit & 1u) ^ static_cast<std::uint32_t>(flip)) << bit;
  }
  return result;
}

double unit(std::uint32_t bits) {
  return (bits + 0.5) * 0x1p-32;
}

std::uint32_t spread(std::uint32_t x) {  // 16 bits to the even places
  std::uint32_t r = 0;
  for (int i = 0; i < 16; ++i) r |= (x >> i & 1u) << (2 * i);
  return r;
}

/// Points of the unit cube: one scramble of one sequence, or random ones.
class PointSource {
 public:
  PointSource(std::uint64_t seed, bool random) : seed_(seed), random_(random), generator_(seed) {
    for (int d = 0; d < 3; ++d) numbers_[static_cast<std::size_t>(d)] = direction_numbers(d);
  }
  /// Random points are taken in rising order of their indices.
  glm::dvec3 point(std::uint32_t index) {
    glm::dvec3 u(0.5);
    if (random_) generator_.discard(3ull * (index - next_));
    next_ = index + 1;
    for (int d = 0; d < 3; ++d) {
      const auto k = static_cast<std::size_t>(d);
      u[d] = random_ ? (static_cast<double>(generator_() >> 11) + 0.5) * 0x1p-53
                     : unit(scramble(sobol(numbers_[k], index), mix(seed_ * 3 + k)));
    }
    return u;
  }

 private:
  std::uint64_t seed_;
  bool random_;
  std::mt19937_64 generator_;
  std::uint32_t next_ = 0;
  std::array<std::array<std::uint32_t, 32>, 3> numbers_;
};

/// Places on the unit square in an order that keeps neighbours together (Morton's).
std::uint32_t morton_code(const glm::dvec3& u) {
  const auto cell = [](double x) {
    return static_cast<std::uint32_t>(std::clamp(x, 0.0, 1.0) * 65535.0);
  };
  return spread(cell(u.x)) | spread(cell(u.y)) << 1;
}

}  // namespace

std::vector<glm::vec4> light_points(const WorldLight& light, std::uint32_t count,
                                    std::uint32_t sets, std::uint64_t seed, bool random,
                                    std::uint32_t scrambles, std::optional<PointRange> part) {
  const PointRange wanted = part.value_or(PointRange{0, count});
  const std::uint32_t all = count / scrambles;
  const std::uint32_t each = wanted.count / scrambles;
  std::vector<glm::vec4> points(std::size_t{each} * scrambles * sets);
  const bool independent = random || (scrambles > 1 && count * sets >= least_independent);
  for (std::uint32_t scramble = 0; scramble < scrambles; ++scramble) {
    PointSource source(independent && scrambles > 1 ? mix(seed ^ mix(scramble)) : seed, random);
    for (std::uint32_t set = 0; set < sets; ++set) {
      const std::uint32_t start = independent ? set * all : set * count + scramble * all;
      const std::uint32_t first = start + wanted.first / scrambles;
      std::vector<std::pair<std::uint32_t, glm::dvec3>> ordered;
      for (std::uint32_t i = 0; i < each; ++i) {
        const glm::dvec3 u = source.point(first + i);
        ordered.emplace_back(morton_code(u), extent_offset(*light.source, u));
      }
      std::stable_sort(ordered.begin(), ordered.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
      for (std::uint32_t i = 0; i < each; ++i) {
        points[(std::size_t{set} * each + i) * scrambles + scramble] =
            glm::vec4(light.extent_point(ordered[i].second), 0.0);
      }
    }
  }
  return points;
}

}  // namespace penumbra
