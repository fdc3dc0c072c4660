#pragma once

#include <array>

#include "renderer/frame/prepare_context.h"

namespace penumbra::reference {

/// Places of the light's points of this batch for the samples at one place in their pixels, in the
/// hierarchy's units, or directions as they are.
std::vector<glm::vec4> points_of(const PrepareContext& context, std::uint32_t set);

/// Boxes around the points of this batch and around the whole light, widened by what rounding may
/// do.
shader::ShaftData shaft_data(const PrepareContext& context, std::uint32_t set);

/// Those around the points of all batches of one bit each.
std::array<shader::BatchBox, shader::batch_bits> batch_boxes(const PrepareContext& context,
                                                             std::uint32_t set);

}  // namespace penumbra::reference
