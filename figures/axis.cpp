#include "figures/axis.h"

#include <algorithm>
#include <cmath>

namespace penumbra::figures {

namespace {

constexpr double tick_length = 2.5;

/// Decimals that tell neighbours on a grid of `step` apart.
int decimals_of(double step) {
  return std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 12);
}

/// Beyond these, digits are counted rather than read.
std::string label_of(double value, int decimals) {
  const double size = std::abs(value);
  if (size != 0.0 && (size >= 1e6 || size < 1e-6)) {
    const int power = static_cast<int>(std::floor(std::log10(size) + 1e-9));
    return number_text(value / std::pow(10.0, power), 1) + "e" + std::to_string(power);
  }
  return shown_number(value, decimals);
}

std::vector<Tick> linear_ticks(double low, double high, std::size_t most) {
  const double rough = (high - low) / static_cast<double>(std::max<std::size_t>(1, most));
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1.0 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  std::vector<Tick> ticks;
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i += 1.0)
    ticks.push_back({i * step, label_of(i * step, decimals_of(step))});
  return ticks;
}

std::vector<Tick> logarithmic_ticks(double low, double high, std::size_t most) {
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  for (const auto& factors : {std::vector<double>{1.0, 2.0, 5.0}, std::vector<double>{1.0, 3.0},
                              std::vector<double>{1.0}}) {
    std::vector<Tick> ticks;
    for (int power = first; power <= last; ++power) {
      for (const double factor : factors) {
        const double value = factor * std::pow(10.0, power);
        if (value < low * (1.0 - 1e-9) || value > high * (1.0 + 1e-9)) continue;
        ticks.push_back({value, label_of(value, std::max(0, -power))});
      }
    }
    if (ticks.size() <= most || factors.size() == 1) {
      const std::size_t pitch = (ticks.size() + most - 1) / std::max<std::size_t>(1, most);
      for (std::size_t i = 0; i < ticks.size(); ++i)
        if (pitch > 1 && i % pitch != 0) ticks[i].label.clear();
      if (ticks.size() >= 2) return ticks;
    }
  }
  return linear_ticks(low, high, most);
}

}  // namespace

double Scale::at(double value) const {
  const double part =
      logarithmic ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
  return begin + part * (end - begin);
}

bool Scale::holds(double value) const {
  return std::isfinite(value) && value >= std::min(from, to) && value <= std::max(from, to);
}

std::vector<Tick> ticks_between(double low, double high, std::size_t most, bool logarithmic) {
  return logarithmic ? logarithmic_ticks(low, high, most) : linear_ticks(low, high, most);
}

std::vector<Tick> whole_ticks(int low, int high, double length, double pitch) {
  const double gap = length / std::max(1, high - low);
  const int step = std::max(1, static_cast<int>(std::ceil(pitch / gap)));
  std::vector<Tick> ticks;
  for (int value = low; value <= high; ++value) {
    const bool named = (value - low) % step == 0;
    ticks.push_back({static_cast<double>(value), named ? std::to_string(value) : ""});
  }
  return ticks;
}

Range range_of(const std::vector<double>& values, bool logarithmic) {
  Range range{0.0, 0.0};
  bool any = false;
  for (const double value : values) {
    if (!std::isfinite(value) || (logarithmic && value <= 0.0)) continue;
    range.low = any ? std::min(range.low, value) : value;
    range.high = any ? std::max(range.high, value) : value;
    any = true;
  }
  if (!any) return logarithmic ? Range{1.0, 10.0} : Range{0.0, 1.0};
  if (logarithmic) {
    const double air = std::max(1.12, std::pow(range.high / range.low, 0.06));
    return {range.low / air, range.high * air};
  }
  double air = 0.06 * (range.high - range.low);
  if (!(air > 0.0)) air = std::max(0.5 * std::abs(range.high), 0.5);
  return {range.low - air, range.high + air};
}

void draw_horizontal_axis(Drawing& drawing, const Scale& scale, const std::vector<Tick>& ticks,
                          double y, std::optional<double> grid_top) {
  for (const Tick& tick : ticks) {
    const double x = scale.at(tick.value);
    if (grid_top) drawing.line({x, *grid_top}, {x, y}, {grid_ink, hairline});
  }
  drawing.line({scale.begin, y}, {scale.end, y});
  for (const Tick& tick : ticks) {
    const double x = scale.at(tick.value);
    drawing.line({x, y}, {x, y + tick_length});
    if (!tick.label.empty())
      drawing.text({x, y + tick_length + line_height - 1.0}, tick.label,
                   {.anchor = Anchor::middle});
  }
}

void draw_vertical_axis(Drawing& drawing, const Scale& scale, const std::vector<Tick>& ticks,
                        double x, std::optional<double> grid_right) {
  for (const Tick& tick : ticks) {
    const double y = scale.at(tick.value);
    if (grid_right) drawing.line({x, y}, {*grid_right, y}, {grid_ink, hairline});
  }
  drawing.line({x, scale.begin}, {x, scale.end});
  for (const Tick& tick : ticks) {
    const double y = scale.at(tick.value);
    drawing.line({x - tick_length, y}, {x, y});
    if (!tick.label.empty())
      drawing.text({x - tick_length - 2.0, y + 0.35 * text_size}, tick.label,
                   {.anchor = Anchor::end});
  }
}

double width_of(const std::vector<Tick>& ticks) {
  double widest = 0.0;
  for (const Tick& tick : ticks) widest = std::max(widest, text_width(tick.label, text_size));
  return widest;
}

}  // namespace penumbra::figures
