#pragma once

#include <cstddef>

#include "renderer/frame/gpu_scene.h"

/// Properties of casters that some techniques cannot handle; for notes.
namespace penumbra {

/// Whether alpha cuts holes into some caster.
bool has_masked_casters(const GpuScene& scene);

/// Casters that enclose no space: sheets, bodies with gaps, surfaces modelled from both sides.
/// Found when first asked for.
std::size_t open_casters(const GpuScene& scene);

}  // namespace penumbra
