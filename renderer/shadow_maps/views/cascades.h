#pragma once

#include "renderer/shadow_maps/views/seen.h"

/// What layouts of cascades share.
namespace penumbra::shadow_maps {

/// What cascaded.glsl chooses by: where the next cascade begins, and where this one ends.
void set_choice(shader::MapView& view, const std::vector<Slice>& slices, std::size_t index);

/// Number of cascades, where they end and how they blend: cascades, split_lambda, cascade_blend.
std::vector<Parameter> split_parameters();

/// The number of cascades is that of views.
std::uint32_t cascade_count(const ParameterValues& parameters);

/// Slices of all that is seen, as those parameters cut it.
std::vector<Slice> cut_slices(const Slice& all, const ParameterValues& parameters);

}  // namespace penumbra::shadow_maps
