#include "renderer/reference/hierarchy.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace penumbra::reference {
namespace {

struct Box {
  glm::vec3 low{std::numeric_limits<float>::max()};
  glm::vec3 high{std::numeric_limits<float>::lowest()};

  void add(const glm::vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  double half_area() const {
    if (low.x > high.x) return 0.0;
    const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }
};

constexpr std::size_t bin_count = 16;
/// Below it the heuristic may degenerate, as with many equal triangles: halves bound the depth.
constexpr int heuristic_depth = 64;

class Builder {
 public:
  explicit Builder(std::span<const Triangle> triangles) {
    boxes_.reserve(triangles.size());
    for (const Triangle& triangle : triangles) {
      Box box;
      for (const glm::vec3& corner : triangle) box.add(corner);
      boxes_.push_back(box);
    }
    order_.resize(triangles.size());
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.reserve(2 * triangles.size());
    if (!order_.empty()) build(0, order_.size(), 0);
  }
  std::vector<Node> take() { return std::move(nodes_); }

 private:
  glm::vec3 center(std::uint32_t triangle) const {
    return 0.5f * boxes_[triangle].low + 0.5f * boxes_[triangle].high;
  }

  void build(std::size_t begin, std::size_t end, int depth) {
    Box box, centers;
    for (std::size_t i = begin; i < end; ++i) {
      box.add(boxes_[order_[i]]);
      centers.add(center(order_[i]));
    }
    const std::size_t index = nodes_.size();
    nodes_.push_back({box.low, 0, box.high, -1});
    if (end - begin == 1) {
      nodes_[index].triangle = static_cast<std::int32_t>(order_[begin]);
    } else {
      const std::size_t middle =
          depth < heuristic_depth ? split(begin, end, centers) : (begin + end) / 2;
      build(begin, middle, depth + 1);
      build(middle, end, depth + 1);
    }
    nodes_[index].next = static_cast<std::uint32_t>(nodes_.size());
  }

  /// Orders [begin, end) by the cheapest plane between bins and returns where the second part
  /// begins.
  std::size_t split(std::size_t begin, std::size_t end, const Box& centers) {
    int best_axis = -1;
    std::size_t best_bin = 0;
    double best_cost = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (!(centers.high[axis] > centers.low[axis])) continue;
      std::array<Box, bin_count> bins;
      std::array<std::size_t, bin_count> counts{};
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t bin = bin_of(order_[i], axis, centers);
        bins[bin].add(boxes_[order_[i]]);
        ++counts[bin];
      }
      std::array<double, bin_count> right_cost{};
      Box side;
      std::size_t count = 0;
      for (std::size_t bin = bin_count - 1; bin > 0; --bin) {
        side.add(bins[bin]);
        count += counts[bin];
        right_cost[bin] = side.half_area() * static_cast<double>(count);
      }
      side = {};
      count = 0;
      for (std::size_t bin = 1; bin < bin_count; ++bin) {
        side.add(bins[bin - 1]);
        count += counts[bin - 1];
        const double cost = side.half_area() * static_cast<double>(count) + right_cost[bin];
        if (count == 0 || count == end - begin || cost >= best_cost) continue;
        best_cost = cost;
        best_axis = axis;
        best_bin = bin;
      }
    }
    if (best_axis < 0) return (begin + end) / 2;  // all centres are one
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    const auto middle = std::stable_partition(at(begin), at(end), [&](std::uint32_t triangle) {
      return bin_of(triangle, best_axis, centers) < best_bin;
    });
    return static_cast<std::size_t>(middle - order_.begin());
  }

  std::size_t bin_of(std::uint32_t triangle, int axis, const Box& centers) const {
    const float share =
        (center(triangle)[axis] - centers.low[axis]) / (centers.high[axis] - centers.low[axis]);
    return std::min(bin_count - 1, static_cast<std::size_t>(share * float{bin_count}));
  }

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace

std::vector<Node> build_hierarchy(std::span<const Triangle> triangles) {
  return Builder(triangles).take();
}

}  // namespace penumbra::reference
