// Claims on irregular adaptive shadow maps against cascades (Alecu 2014).
#include <algorithm>
#include <cmath>
#include <string>

#include "experiments/claims/claim.h"
#include "experiments/claims/hard_light.h"
#include "renderer/metrics/metrics.h"
#include "scenes/generators/scene_builder.h"

namespace penumbra::experiments::claims {
namespace {

using std::to_string;

std::uint64_t map_bytes(const RenderResult& drawn) {
  std::uint64_t bytes = 0;
  for (const ResourceCost& cost : drawn.cost.technique_memory)
    if (cost.name == "shadow map") bytes += cost.bytes;
  return bytes;
}

Outcome q22(Laboratory& lab) {
  Outcome outcome;
  for (const std::string id : {"trees", "village"}) {
    const SharedScene scene = with_hard_lights(*lab.engine().scene(id));
    const RenderResult truth = lab.draw(scene, id, one_ray);
    const RenderResult tiles = lab.draw(scene, id, "iasm");
    const RenderResult cascades = lab.draw(scene, id, "cascaded");
    const double own = error_to(tiles, truth), other = error_to(cascades, truth);
    outcome.number("error of IASM, " + id, own);
    outcome.number("of CSM, " + id, other);
    if (id == "trees") {
      outcome.number("bytes of IASM", static_cast<double>(map_bytes(tiles)));
      outcome.number("bytes of CSM", static_cast<double>(map_bytes(cascades)));
      outcome.part(own < 1.25 * other);
      outcome.part(map_bytes(tiles) == 6860800u && map_bytes(cascades) == 12582912u);
    }
  }
  return outcome;
}

/// Posts all round a camera, which looks so that its direction lies at an angle from the first axis
/// of the light's plane, degrees.
SharedScene posts_at_yaw(double degrees) {
  scenes::SceneBuilder b("posts", "Posts all round");
  const scenes::Look grey = b.look("grey", glm::vec3(0.7f));
  b.ground({-100.0, -100.0}, {100.0, 100.0}, grey);
  const std::uint32_t post = [&] {
    Mesh mesh;
    scenes::add_part(mesh, scenes::box({-0.2, -0.1, -0.2}, {0.2, 2.4, 0.2}), grey);
    return b.add_mesh("post", std::move(mesh));
  }();
  for (int z = -14; z <= 14; ++z)
    for (int x = -14; x <= 14; ++x) {
      // Apart by golden sections, so that rows line up from no side.
      const double shift = 1.6 * std::fmod(0.618 * x + 0.382 * z + 20.0, 1.0);
      glm::dmat4 place(1.0);
      place[3] = glm::dvec4(3.0 * x + shift, 0.0, 3.0 * z + 1.5 - shift, 1.0);
      if (std::hypot(place[3].x, place[3].z) > 1.5) b.place(post, place, "post");
    }
  const Light& sun = b.sun({0.35, -1.0, 0.2}, glm::vec3(1.0f), 1.0f);
  const FixedAxes axes = axes_of(sun);
  const double angle = glm::radians(degrees);
  const glm::dvec3 ahead = std::cos(angle) * axes.right + std::sin(angle) * axes.up;
  // Level with the ground, along the light from there: its place in the light's plane is the same.
  const glm::dvec3 level = ahead - ahead.y / axes.forward.y * axes.forward;
  const glm::dvec3 eye(0.0, 2.0, 0.0);
  b.camera("main", eye, eye + glm::normalize(level) + glm::dvec3(0.0, -0.25, 0.0), 50.0);
  return with_hard_lights(std::move(b.scene));
}

Outcome q23(Laboratory& lab) {
  Outcome outcome;
  double worst_at = 0.0;
  std::vector<double> tiles, cascades;
  for (int step = 0; step <= 12; ++step) {
    const double yaw = 7.5 * step;
    const SharedScene scene = posts_at_yaw(yaw);
    const RenderResult truth = lab.draw(scene, "posts", one_ray);
    const auto error_near = [&](const char* technique) {
      return error_in_rows(lab.draw(scene, "posts", technique), truth, 0.5, 1.0);
    };
    tiles.push_back(error_near("shadow-map:layout=iasm:tile_radius=50"));
    cascades.push_back(error_near("cascaded"));
    if (tiles.back() == *std::max_element(tiles.begin(), tiles.end())) worst_at = yaw;
  }
  const auto worst_over_median = [](std::vector<double> errors) {
    std::sort(errors.begin(), errors.end());
    return errors.back() / errors[errors.size() / 2];
  };
  const double own = worst_over_median(tiles), other = worst_over_median(cascades);
  outcome.number("worst over median near the camera, IASM", own);
  outcome.number("CSM", other);
  outcome.number("degrees at IASM's worst", worst_at);
  outcome.number("median error, IASM", [&] {
    std::sort(tiles.begin(), tiles.end());
    return tiles[tiles.size() / 2];
  }());
  outcome.part(own > 1.25);
  outcome.part(other < 1.25);
  outcome.part(std::abs(worst_at - 45.0) <= 15.0);
  return outcome;
}

double false_shadow_of(const RenderResult& drawn, const RenderResult& truth) {
  return metrics::visibility_error(drawn.visibility, truth.visibility, drawn.judged).false_shadow;
}

Outcome q44(Laboratory& lab) {
  const std::string map = "shadow-map:layout=iasm:tile_sizes=";
  const double own = flicker(lab, one_ray, false);
  Outcome outcome;
  const double set = flicker(lab, map + "set", false) - own;
  const double free = flicker(lab, map + "proportional", false) - own;
  outcome.number("change beyond exact shadows, set of sizes", set);
  outcome.number("in proportion", free);
  outcome.part(free > set);
  double acne_of_set = 0.0, acne_of_free = 0.0;
  for (const char* id : {"trees", "village"}) {
    const SharedScene scene = with_hard_lights(*lab.engine().scene(id));
    const RenderResult truth = lab.draw(scene, id, one_ray);
    acne_of_set += false_shadow_of(lab.draw(scene, id, map + "set"), truth);
    acne_of_free += false_shadow_of(lab.draw(scene, id, map + "proportional"), truth);
  }
  outcome.number("false_shadow of trees and village, set", acne_of_set);
  outcome.number("false_shadow, in proportion", acne_of_free);
  outcome.part(acne_of_free > acne_of_set);
  return outcome;
}

Outcome q48(Laboratory& lab) {
  Outcome outcome;
  for (const std::string id : {"trees", "village"}) {
    const SharedScene scene = with_hard_lights(*lab.engine().scene(id));
    const RenderResult truth = lab.draw(scene, id, one_ray);
    const auto error_near = [&](const std::string& what, const std::string& technique) {
      const double error = error_in_rows(lab.draw(scene, id, technique), truth, 0.75, 1.0);
      outcome.number(what + ", " + id, error);
      return error;
    };
    const std::string hard = "shadow-map:depth_bits=16:";
    const std::string csm = "layout=cascaded:cascades=3:map_size=1024";
    const double seen = error_near("IASM, ranges of what is seen", hard + "layout=iasm");
    const double casters = error_near("of casters", hard + "layout=iasm:tile_range=casters");
    const double common = error_near("one range", hard + "layout=iasm:tile_range=common");
    const double cascades = error_near("CSM", hard + csm);
    outcome.part(seen < cascades);
    outcome.part(seen < common && casters < common);
    const double exponential = error_near("ESM on IASM", "esm:layout=iasm");
    outcome.part(exponential < error_near("ESM on CSM", "esm:" + csm));
  }
  outcome.note = "exponential maps take one range for all tiles: c is a share of it";
  return outcome;
}

/// Means over the six survey scenes.
Outcome q37(Laboratory& lab) {
  Outcome outcome;
  double acne[2] = {}, leak[2] = {};
  const char* ranges[] = {"boxes", "visible"};
  for (const char* id :
       {"car", "boxes", "disco-box", "island", "warehouse-inside", "warehouse-outside"}) {
    const SharedScene scene = with_hard_lights(*lab.engine().scene(id));
    const RenderResult truth = lab.draw(scene, id, one_ray);
    for (int i = 0; i < 2; ++i) {
      const std::string range = std::string(":range=") + ranges[i];
      const auto error = [&](const std::string& technique) {
        const RenderResult drawn = lab.draw(scene, id, technique + range);
        return metrics::visibility_error(drawn.visibility, truth.visibility, drawn.judged);
      };
      acne[i] += error("shadow-map:depth=hyperbolic:depth_bits=16").false_shadow / 6.0;
      leak[i] += error("esm").missing_shadow / 6.0;
    }
  }
  for (int i = 0; i < 2; ++i) {
    outcome.number(std::string("false_shadow at 16 bits of 1/z, ") + ranges[i], acne[i]);
    outcome.number(std::string("missing_shadow of ESM, ") + ranges[i], leak[i]);
  }
  outcome.part(acne[1] < acne[0]);
  outcome.part(leak[1] < leak[0]);
  return outcome;
}

}  // namespace

std::vector<Claim> tile_claims() {
  return {
      {"Q22", "S1 4.2", "IASM is close to CSM in 6,860,800 against 12,582,912 bytes",
       "on trees its error is below 1.25 times CSM's; bytes exactly these", q22},
      {"Q23", "S1 fig. 4.4", "IASM shows borders of tiles near the camera, CSM none",
       "over a quarter turn of the camera, nearer half of the picture: worst over median error of "
       "IASM over 1.25; of CSM below 1.25; IASM's worst within 15 degrees of 45",
       q23},
      {"Q37", "S0 2.2.3",
       "near at the nearest place seen, casters clamped onto it, beats near at the nearest caster",
       "mean over the survey's scenes, hard lights: less false_shadow at 16 bits of 1/z; less "
       "missing_shadow of ESM",
       q37},
      {"Q44", "S1 5", "freely chosen sizes of tiles bring acne and flicker",
       "sizes in proportion to importance against the set: more points change as the camera moves; "
       "more false_shadow",
       q44},
      {"Q48", "S1 fig. 4.5", "tight ranges of tiles beat CSM close to the camera",
       "error near the camera at 16 bits, on trees and on village each: ranges of what is seen "
       "below CSM's; these and those of casters below one range's; ESM below ESM on CSM",
       q48},
  };
}

}  // namespace penumbra::experiments::claims
