#pragma once

#include "renderer/shadow_maps/seen.h"

/// What layouts of cascades share.
namespace penumbra::shadow_maps {

/// Splits between even depths (lambda 0) and even ratios of depths (lambda 1): the practical scheme
/// of Zhang et al. 2006. One more than there are cascades.
std::vector<double> split_depths(const Slice& all, std::int64_t cascades, double lambda);

/// Slices between splits; each begins where the one before it starts to blend, the last part
/// `blend` of its depth.
std::vector<Slice> blended_slices(const std::vector<double>& splits, double blend);

/// What cascaded.glsl chooses by: where the next cascade begins, and where this one ends.
void set_choice(shader::MapView& view, const std::vector<Slice>& slices, std::size_t index);

/// Number of cascades, where they end and how they blend: `prefix` and cascades, lambda, blend.
struct CascadeNames {
  const char* cascades;
  const char* lambda;
  const char* blend;
};
std::vector<Parameter> split_parameters(const CascadeNames& names);

/// The number of cascades is that of views.
std::uint32_t cascade_count(const ParameterValues& parameters, const CascadeNames& names);

}  // namespace penumbra::shadow_maps
