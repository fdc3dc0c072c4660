// Claims on what occluder textures cost beside a shadow map (Coleman 2006).
#include <string>

#include "experiments/claims/claim.h"
#include "experiments/claims/laboratory.h"

namespace penumbra::experiments::claims {
namespace {

constexpr auto by_textures = "occluder-textures";
constexpr auto by_map = "shadow-map";

double frame_ratio(Laboratory& lab, const std::string& scene, std::uint32_t size) {
  return lab.value("frame_ms", scene, by_textures, Truth::none, size) /
         lab.value("frame_ms", scene, by_map, Truth::none, size);
}

/// Of surfaces and of casters, without the triangle that draws the sky.
double submitted(const Cost& cost, std::uint64_t PassCost::*what, double of_sky) {
  double sum = -of_sky;
  for (const PassCost& pass : cost.passes)
    if (pass.name == "geometry" || pass.name == "shadow map")
      sum += static_cast<double>(pass.*what);
  return sum;
}

Outcome c11(Laboratory& lab) {
  const std::uint32_t large = 2 * lab.scale().size, small = lab.scale().size / 8;
  Outcome outcome;
  const double aircraft = frame_ratio(lab, "aircraft", lab.scale().size);
  outcome.number("textures over map, aircraft", aircraft);
  outcome.part(aircraft > 0.9 && aircraft < 1.1);
  const double many = frame_ratio(lab, "fleet:200", small);
  outcome.number("200 aircraft, small picture", many);
  outcome.part(many < 1.0);
  const double fill = frame_ratio(lab, "fleet:1", large);
  outcome.number("one aircraft, large picture", fill);
  outcome.part(fill > 1.0);
  return outcome;
}

Outcome c27(Laboratory& lab) {
  const Cost own = lab.draw("aircraft", by_textures).cost,
             other = lab.draw("aircraft", by_map).cost;
  Outcome outcome;
  const auto compare = [&](const std::string& name, std::uint64_t PassCost::*what, double of_sky) {
    const double half = submitted(own, what, of_sky), all = submitted(other, what, of_sky);
    outcome.number(name + " with textures", half);
    outcome.number(name + " with a map", all);
    outcome.part(2.0 * half == all);
  };
  compare("vertices", &PassCost::vertices, 3.0);
  compare("primitives", &PassCost::primitives, 1.0);
  return outcome;
}

}  // namespace

std::vector<Claim> fleet_claims() {
  return {
      {"C11", "S2 6.2",
       "occluder textures cost about a shadow map on the aircraft, less where the processor "
       "submits much, more where pixels rule",
       "frame over that of the map within 10% on the aircraft; below 1 with 200 of them in a small "
       "picture; above 1 with one in a large",
       c11, Needs::gpu},
      {"C27", "S2 6.2", "occluder textures halve what the processor submits",
       "exactly half of the map's vertices; of its primitives", c27},
  };
}

}  // namespace penumbra::experiments::claims
