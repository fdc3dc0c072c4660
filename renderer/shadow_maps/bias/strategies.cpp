#include "renderer/shadow_maps/bias/strategies.h"

#include <algorithm>

#include "renderer/frame/caster_defects.h"

namespace penumbra::shadow_maps {

const std::vector<BiasStrategy>& bias_strategies() {
  static const std::vector<BiasStrategy> strategies = {
      {"constant", "depth is moved away from the light, for facets at 45 degrees"},
      {"slope", "by what each caster's facet spans over the kernel", MapSurfaces::first, true},
      {"normal-offset", "the receiver is moved along its normal"},
      {"receiver-plane",
       "every texel is compared with the receiver's plane at the texel's own place"},
      {"back-faces", "only faces turned away from the light are drawn", MapSurfaces::back_faces,
       true},
      {"second-depth", "the second surface from the light is", MapSurfaces::first_and_second},
      {"midpoint", "the middle between the first two", MapSurfaces::first_and_second},
      {"dual-depth", "that, but never far behind the first", MapSurfaces::first_and_second},
      {"auto", "receiver-plane, and the map moved by as much as that grants, never past the middle",
       MapSurfaces::first_and_second}};
  return strategies;
}

const BiasStrategy& chosen_strategy(const ParameterValues& parameters) {
  const std::string& id = choice_of(parameters, "bias_strategy");
  return *std::find_if(bias_strategies().begin(), bias_strategies().end(),
                       [&](const BiasStrategy& strategy) { return strategy.id == id; });
}

bool keeps_first_surfaces(const ParameterValues& parameters) {
  const BiasStrategy& strategy = chosen_strategy(parameters);
  return strategy.surfaces == MapSurfaces::first && !strategy.moves_facets;
}

bool knows_two_surfaces(const ParameterValues& parameters) {
  return chosen_strategy(parameters).surfaces == MapSurfaces::first_and_second;
}

std::vector<Parameter> bias_parameters() {
  std::vector<std::string> ids;
  std::string meaning = "How self-shadowing is prevented.";
  for (const BiasStrategy& strategy : bias_strategies()) {
    ids.push_back(strategy.id);
    meaning += " " + strategy.id + ": " + strategy.meaning + ".";
  }
  return {choice("bias_strategy", "receiver-plane", ids, meaning).compiled(),
          real("bias", 0.0, {0.0, 1000.0},
               "Distance along the light's axis granted to every comparison, beside what the "
               "strategy finds.")
              .in("m"),
          real("slope_scale", 1.0, {0.0, 16.0},
               "Factor of what the strategy finds from texel size, kernel, slope and rounding; 1 "
               "is enough, 0 leaves only bias.")};
}

void note_open_casters(PrepareContext& context) {
  const BiasStrategy& strategy = chosen_strategy(context.input.parameters);
  if (strategy.surfaces == MapSurfaces::first) return;
  const std::size_t open = open_casters(context.scene);
  if (open > 0)
    context.notes.push_back(
        "bias_strategy " + strategy.id +
        " takes casters for closed bodies; shadows of those with open edges are "
        "late or missing: " +
        std::to_string(open));
}

}  // namespace penumbra::shadow_maps
