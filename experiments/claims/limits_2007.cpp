// Claims on table 4.1 of van Sambeek 2007: how many objects a technique draws in real time, and
// what bounds it.
#include <set>
#include <string>

#include "experiments/claims/claim.h"
#include "experiments/claims/laboratory.h"
#include "experiments/report/rows.h"
#include "experiments/sweep/grid.h"
#include "experiments/sweep/limits.h"
#include "renderer/error.h"

namespace penumbra::experiments::claims {
namespace {

using nlohmann::json;

/// Low and high poly, as he tried them.
constexpr int low_poly = swept_triangles[0], high_poly = swept_triangles[1];

/// 1200 pixels at full scale: those of the limits that table 4.1 gives for its largest pictures.
std::uint32_t size_of(const Laboratory& lab) {
  return 2 * lab.scale().survey_size;
}

/// Times at one size, for every technique until a frame takes more than real time.
std::vector<json> rows_until_real_time(Laboratory& lab, int triangles) {
  std::vector<json> rows;
  std::set<std::string> over;
  for (const int objects : {1, 5, 10, 25, 50, 100, 200, 400, 800})
    for (const PublishedLimit& published : table_4_1()) {
      if (published.technique == "none" || over.contains(published.technique)) continue;
      const std::string scene = sweep_scene({objects, triangles, swept_lights});
      rows.push_back(lab.row(scene, published.technique, Truth::none, size_of(lab)));
      if (number_of(rows.back(), "frame_ms") >= real_time_ms) over.insert(published.technique);
    }
  return rows;
}

Outcome c13(Laboratory& lab) {
  Outcome outcome;
  for (const int triangles : {low_poly, high_poly}) {
    const auto rows = rows_until_real_time(lab, triangles);
    std::vector<double> ours, theirs;
    for (const PublishedLimit& published : table_4_1()) {
      const auto limits = limits_of(time_grid(rows, published.technique, triangles, swept_lights));
      if (!limits) continue;
      ours.push_back(limits->at_largest);
      theirs.push_back(published.objects[triangles == high_poly].value_or(1e9));
      outcome.number(published.label + ", " + std::to_string(triangles) + " triangles" +
                         (limits->beyond ? ", or more" : ""),
                     limits->at_largest);
    }
    const Agreement order = agreement(ours, theirs);
    outcome.number("pairs in his order, " + std::to_string(triangles) + " triangles",
                   static_cast<double>(order.agreeing));
    outcome.number("pairs told apart, " + std::to_string(triangles) + " triangles",
                   static_cast<double>(order.pairs));
    outcome.part(order.pairs > 0 && order.agreeing == order.pairs);
  }
  outcome.note = "objects that stay under 50 ms under three lights at " +
                 std::to_string(size_of(lab)) + " pixels, linear between those tried";
  return outcome;
}

Growth growth_of_technique(Laboratory& lab, const std::string& technique) {
  std::vector<json> rows;
  for (const int objects : {1, 10, 50})
    for (const std::uint32_t share : {4u, 2u, 1u})
      rows.push_back(lab.row(sweep_scene({objects, high_poly, swept_lights}), technique,
                             Truth::none, size_of(lab) / share));
  const auto growth = growth_of(time_grid(rows, technique, high_poly, swept_lights));
  if (!growth) throw unsupported("no growth can be told of " + technique);
  return *growth;
}

Outcome c25(Laboratory& lab) {
  need_stencil_fragments(lab);
  Outcome outcome;
  const Growth none = growth_of_technique(lab, "none");
  for (const PublishedLimit& published : table_4_1()) {
    if (published.technique == "none") continue;
    const Growth growth = growth_of_technique(lab, published.technique);
    outcome.number(published.label + ", over pixels", growth.over_pixels);
    outcome.number(published.label + ", over objects", growth.over_objects);
    outcome.number(published.label + ", fragments a pixel", growth.fragments_per_pixel);
    outcome.part(bottleneck_of(growth, none) == published.bottleneck);
  }
  outcome.note =
      "exponents of time; fill rate: over 8 fragments a pixel beyond those without shadows; "
      "geometry: over pixels below 0.25; otherwise shaders";
  return outcome;
}

}  // namespace

std::vector<Claim> limit_claims() {
  return {
      {"C13", "S0 table 4.1",
       "under 50 ms at 1200 x 1200: low poly SSM, VSM 150, PCF 135, SV 75, SSV 25, PCSS 0 objects; "
       "high SSM 140, PCF 82, VSM 80, SV 8, SSV 4, PCSS 0",
       "all pairs that both tables tell apart stand in his order: low poly; high poly", c13,
       Needs::gpu},
      {"C25", "S0 table 4.1", "maps are bound by shaders, volumes by fill rate",
       "SSM shaders; PCF; PCSS; VSM; SV fill rate; SSV", c25, Needs::gpu},
  };
}

}  // namespace penumbra::experiments::claims
