#include "renderer/metrics/frame_change.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "renderer/error.h"

namespace penumbra::metrics {
namespace {

/// Nearer to a sample than this a point is that sample, pixels.
constexpr double same_place = 0.01;

/// Samples of one surface that surround a point are seen no farther than this from it, pixels.
constexpr double most_apart = 2.0;

/// Samples around a place: the same one twice along an axis on which the place lies on it.
struct Around {
  std::array<std::uint32_t, 2> columns;
  std::array<std::uint32_t, 2> rows;
};

struct Span {
  double low, high;
};

glm::dvec3 point_at(const PathFrame& frame, std::uint32_t x, std::uint32_t y) {
  const float* point = &frame.points.at(x, y, 0);
  return {point[0], point[1], point[2]};
}

bool shows_surface(const PathFrame& frame, std::uint32_t x, std::uint32_t y) {
  return frame.points.at(x, y, 3) > 0.5f;
}

/// Where a frame's camera sees a point, pixels, with whole numbers at samples.
std::optional<glm::dvec2> place_of(const glm::dvec3& point, const PathFrame& frame) {
  const glm::dvec4 clip = frame.clip_from_world * glm::dvec4(point, 1.0);
  if (!(clip.w > 0.0)) return std::nullopt;
  const glm::dvec2 size(frame.points.width, frame.points.height);
  return (0.5 + 0.5 * glm::dvec2(clip) / clip.w) * size - frame.sample;
}

/// The samples before and behind a place along an axis of `size` of them.
std::optional<std::array<std::uint32_t, 2>> neighbours(double place, std::uint32_t size) {
  const double first = std::floor(place + same_place);
  const double last = place - first > same_place ? first + 1.0 : first;
  if (!(first >= 0.0 && last < size)) return std::nullopt;
  return std::array{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
}

/// The samples of the frame before that surround what `now` shows in pixel (x, y), if they show the
/// same surface.
std::optional<Around> samples_around(const PathFrame& before, const PathFrame& now, std::uint32_t x,
                                     std::uint32_t y) {
  if (!shows_surface(now, x, y)) return std::nullopt;
  const auto place = place_of(point_at(now, x, y), before);
  if (!place) return std::nullopt;
  const auto columns = neighbours(place->x, before.points.width);
  const auto rows = neighbours(place->y, before.points.height);
  if (!columns || !rows) return std::nullopt;
  for (const std::uint32_t row : *rows)
    for (const std::uint32_t column : *columns) {
      if (!shows_surface(before, column, row)) return std::nullopt;
      const auto back = place_of(point_at(before, column, row), now);
      if (!back || glm::length(*back - glm::dvec2(x, y)) > most_apart) return std::nullopt;
    }
  return Around{*columns, *rows};
}

/// From the least to the greatest visibility of a light around a place, where it is judged.
std::optional<Span> span_of(const PathFrame& frame, const Around& around, std::uint32_t light) {
  Span span{1.0, 0.0};
  for (const std::uint32_t row : around.rows)
    for (const std::uint32_t column : around.columns) {
      if (!(frame.judged.at(column, row, light) > 0.5f)) return std::nullopt;
      const double lit = frame.visibility.at(column, row, light);
      if (!std::isfinite(lit)) return std::nullopt;
      span = {std::min(span.low, lit), std::max(span.high, lit)};
    }
  return span;
}

}  // namespace

void FrameChange::add(PathFrame frame) {
  if (!last_.points.empty()) compare(last_, frame);
  last_ = std::move(frame);
}

void FrameChange::compare(const PathFrame& before, const PathFrame& now) {
  if (before.points.width != now.points.width || before.points.height != now.points.height ||
      before.visibility.channels != now.visibility.channels)
    throw bad_value("width", "frames of a path must have one size and the same lights");
  for (std::uint32_t y = 0; y < now.points.height; ++y) {
    for (std::uint32_t x = 0; x < now.points.width; ++x) {
      const auto around = samples_around(before, now, x, y);
      if (!around) continue;
      for (std::uint32_t light = 0; light < now.visibility.channels; ++light) {
        if (!(now.judged.at(x, y, light) > 0.5f)) continue;
        const auto span = span_of(before, *around, light);
        if (!span) continue;
        const double lit = now.visibility.at(x, y, light);
        const double change = std::max({span->low - lit, lit - span->high, 0.0});
        // One that is no number counts as a change from dark to lit.
        sum_ += std::isfinite(lit) ? change * change : 1.0;
        ++points_;
      }
    }
  }
}

double FrameChange::mean_square() const {
  return points_ > 0 ? sum_ / static_cast<double>(points_) : 0.0;
}

double frame_difference(const FrameChange& technique, const FrameChange& reference) {
  return std::sqrt(std::max(0.0, technique.mean_square() - reference.mean_square()));
}

}  // namespace penumbra::metrics
