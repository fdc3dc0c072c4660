#pragma once

#include "renderer/frame/prepare_context.h"

namespace penumbra::shadow_maps {

/// Surfaces, from the light on, that a map is made of.
enum class MapSurfaces { first, back_faces, first_and_second };

/// A way to keep surfaces from shadowing themselves. What it grants is told by strategies.glsl.
struct BiasStrategy {
  std::string id;       ///< value of parameter `bias_strategy`
  std::string meaning;  ///< a few words in that parameter's description
  MapSurfaces surfaces = MapSurfaces::first;
  bool moves_facets = false;  ///< casters' facets are moved by their slopes
};

const std::vector<BiasStrategy>& bias_strategies();

/// The one that parameter `bias_strategy` names.
const BiasStrategy& chosen_strategy(const ParameterValues& parameters);

/// Whether the map is made of the surfaces nearest to the light, where they are.
bool keeps_first_surfaces(const ParameterValues& parameters);

bool knows_two_surfaces(const ParameterValues& parameters);

/// bias_strategy, bias, slope_scale.
std::vector<Parameter> bias_parameters();

/// Notes casters that are not closed where the map is made of other surfaces than the first.
void note_open_casters(PrepareContext& context);

}  // namespace penumbra::shadow_maps
