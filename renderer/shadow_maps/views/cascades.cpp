#include "renderer/shadow_maps/views/cascades.h"

#include <cmath>

namespace penumbra::shadow_maps {
namespace {

/// Splits between even depths (lambda 0) and even ratios of depths (lambda 1): the practical scheme
/// of Zhang et al. 2006. One more than there are cascades.
std::vector<double> split_depths(const Slice& all, std::int64_t cascades, double lambda) {
  std::vector<double> splits;
  for (std::int64_t i = 0; i <= cascades; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(cascades);
    const double even = all.near + all.depth() * share;
    splits.push_back(lambda * all.near * std::pow(all.far / all.near, share) +
                     (1.0 - lambda) * even);
  }
  return splits;
}

/// Slices between splits; each begins where the one before it starts to blend, the last part
/// `blend` of its depth.
std::vector<Slice> blended_slices(const std::vector<double>& splits, double blend) {
  std::vector<Slice> slices;
  double begin = splits.front();
  for (std::size_t i = 0; i + 1 < splits.size(); ++i) {
    slices.push_back({begin, splits[i + 1]});
    begin = splits[i + 1] - blend * (splits[i + 1] - splits[i]);
  }
  slices.push_back({begin, splits.back()});  // where a cascade after the last would begin
  return slices;
}

}  // namespace

void set_choice(shader::MapView& view, const std::vector<Slice>& slices, std::size_t index) {
  view.choice = {static_cast<float>(slices[index + 1].near), static_cast<float>(slices[index].far),
                 0.0f, 0.0f};
}

std::vector<Parameter> split_parameters() {
  constexpr std::int64_t most_cascades = 8;
  return {integer("cascades", 4, {2, most_cascades},
                  "Cascades that the depth before the camera is cut into, each map_size wide."),
          real("split_lambda", 0.5, {0.0, 1.0},
               "Where cascades end. 0: all are equally deep. 1: each is as many times deeper than "
               "the one before it."),
          real("cascade_blend", 0.1, {0.0, 0.5},
               "Last part of a cascade's depth, over which the next one takes over gradually.")
              .in("of depth")};
}

std::uint32_t cascade_count(const ParameterValues& parameters) {
  return static_cast<std::uint32_t>(integer_of(parameters, "cascades"));
}

std::vector<Slice> cut_slices(const Slice& all, const ParameterValues& parameters) {
  return blended_slices(
      split_depths(all, cascade_count(parameters), real_of(parameters, "split_lambda")),
      real_of(parameters, "cascade_blend"));
}

}  // namespace penumbra::shadow_maps
