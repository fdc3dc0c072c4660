// Claims about where depth lives: focused, warped and split maps, and levels of filtered ones.
#include <algorithm>
#include <cmath>
#include <string>

#include "experiments/claims/claim.h"
#include "experiments/claims/hard_light.h"
#include "renderer/metrics/metrics.h"
#include "renderer/shadow_maps/layout.h"
#include "scenes/generators/scene_builder.h"

namespace penumbra::experiments::claims {
namespace {

/// A plain seen from 2 m, and a beam over and behind the camera that shadows the ground before it.
Scene beam_behind_camera() {
  scenes::SceneBuilder b("beam", "A beam behind the camera");
  const scenes::Look grey = b.look("grey", glm::vec3(0.7f));
  b.ground({-40.0, -120.0}, {40.0, 14.0}, grey);
  b.place(scenes::box({-1.5, 9.0, 8.0}, {1.5, 11.0, 10.0}), grey, "beam");
  b.sun({0.0, -1.0, -1.0}, glm::vec3(1.0f), 1.0f);
  b.camera("main", {0.0, 2.0, 5.0}, {0.0, 1.0, -20.0}, 50.0);
  return std::move(b.scene);
}

/// Share of the pixels inside a shadow that are lit. A map may miss its border by a texel or two:
/// what is nearer to it than a thirtieth of the picture does not count.
double lost_inside(const RenderResult& drawn, const RenderResult& truth) {
  const std::uint32_t reach = truth.visibility.width / 30;
  std::size_t inside = 0, lost = 0;
  for (std::uint32_t y = reach; y + reach < truth.visibility.height; ++y)
    for (std::uint32_t x = reach; x + reach < truth.visibility.width; ++x) {
      bool dark = truth.judged.at(x, y, 0) > 0.5f;
      for (std::uint32_t v = y - reach; dark && v <= y + reach; ++v)
        for (std::uint32_t u = x - reach; dark && u <= x + reach; ++u)
          dark = truth.visibility.at(u, v, 0) < 0.5f;
      inside += dark;
      lost += dark && drawn.visibility.at(x, y, 0) > 0.1f;
    }
  return inside == 0 ? 0.0 : static_cast<double>(lost) / static_cast<double>(inside);
}

Outcome q38(Laboratory& lab) {
  Scene scene = beam_behind_camera();
  const SharedScene whole = with_hard_lights(scene);
  const RenderResult truth = lab.draw(whole, "beam", one_ray);
  Outcome outcome;
  for (const std::string& layout : shadow_maps::layouts_for(LightKind::directional)) {
    const double lost = lost_inside(lab.draw(whole, "beam", "shadow-map:layout=" + layout), truth);
    outcome.number("lost, " + layout, lost);
    outcome.part(lost == 0.0);
  }
  // A map of what the camera sees holds no beam.
  scene.instances.back().casts_shadow = false;
  const double ablated = lost_inside(
      lab.draw(with_hard_lights(scene), "beam left out", "shadow-map:focus=seen"), truth);
  outcome.number("lost, casters outside of the view left out", ablated);
  outcome.part(ablated == 1.0);
  return outcome;
}

Outcome q39(Laboratory& lab) {
  const std::string map = "shadow-map:layout=cascaded:map_size=256:cascade_snapping=";
  Outcome outcome;
  for (const bool light_moves : {false, true}) {
    const std::string what = light_moves ? ", light moves" : ", camera moves";
    const double own = flicker(lab, one_ray, light_moves);
    const double loose = flicker(lab, map + "false", light_moves) - own;
    const double snapped = flicker(lab, map + "true", light_moves) - own;
    outcome.number("change of exact shadows" + what, own);
    outcome.number("beyond it, not snapped" + what, loose);
    outcome.number("beyond it, snapped" + what, snapped);
    outcome.part(loose > 0.002);
    // Whole texels help against a moving camera. Under a moving light nothing can.
    if (!light_moves) outcome.part(snapped < 0.25 * loose);
  }
  return outcome;
}

Outcome q42(Laboratory& lab) {
  const SharedScene tower = lab.engine().scene("tower");
  Outcome outcome;
  std::vector<double> shares;
  for (const int blur : {0, 1, 3}) {
    const RenderResult drawn =
        lab.draw(tower, "tower", "vsm:map_size=2048:blur_filter=box:blur=" + std::to_string(blur),
                 0, "mip-level");
    std::size_t finest = 0, judged = 0;
    for (std::uint32_t y = 0; y < drawn.diagnostic.height; ++y)
      for (std::uint32_t x = 0; x < drawn.diagnostic.width; ++x) {
        const bool told = drawn.diagnostic.at(x, y, 0) + drawn.diagnostic.at(x, y, 1) +
                              drawn.diagnostic.at(x, y, 2) >
                          0;
        judged += told;
        // Level 0 is red.
        finest += told && drawn.diagnostic.at(x, y, 0) == 255 && drawn.diagnostic.at(x, y, 1) < 3;
      }
    shares.push_back(static_cast<double>(finest) /
                     static_cast<double>(std::max<std::size_t>(judged, 1)));
    outcome.number("share at level 0, " + std::to_string(2 * blur + 1) + " texels", shares.back());
  }
  outcome.part(shares[1] > shares[0] && shares[2] > shares[1]);
  return outcome;
}

/// The trees, with a sun whose direction is at an angle to the view's and in its upright plane: 90
/// degrees is a light from the zenith.
SharedScene trees_lit_at(Laboratory& lab, double degrees) {
  Scene scene = *lab.engine().scene("trees");
  const Camera& camera = scene.cameras.front();
  const glm::dvec3 ahead = glm::normalize(camera.target - camera.position);
  const glm::dvec3 right = glm::normalize(glm::cross(ahead, {0.0, 1.0, 0.0}));
  const glm::dvec3 down = glm::cross(ahead, right);
  const double angle = glm::radians(degrees);
  scene.lights.front().direction = std::cos(angle) * ahead + std::sin(angle) * down;
  return with_hard_lights(std::move(scene));
}

Outcome q45(Laboratory& lab) {
  Outcome outcome;
  const std::vector<double> angles = {12.0, 30.0, 60.0, 90.0};
  for (const std::string layout :
       {"perspective", "light-space-perspective", "trapezoidal", "cascaded"}) {
    std::vector<double> ratios;
    for (const double angle : angles) {
      const SharedScene scene = trees_lit_at(lab, angle);
      const RenderResult truth = lab.draw(scene, "trees", one_ray);
      // Of the same bytes: four cascades of 256 are one map of 512.
      const std::string size = layout == "cascaded" ? "256:cascades=4" : "512";
      const double own = error_to(
          lab.draw(scene, "trees", "shadow-map:layout=" + layout + ":map_size=" + size), truth);
      const double plain =
          error_to(lab.draw(scene, "trees", "shadow-map:focus=seen:map_size=512"), truth);
      ratios.push_back(own / plain);
      outcome.number(
          layout + " over plain, " + std::to_string(static_cast<int>(angle)) + " degrees",
          ratios.back());
    }
    if (layout == "cascaded") {
      const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
      outcome.part(*most < 1.5 * *least);
    } else {
      outcome.part(ratios.back() < ratios.front());
      outcome.part(std::abs(ratios.front() - 1.0) < 0.15);
    }
  }
  return outcome;
}

Outcome q46(Laboratory& lab) {
  // As many texels over the tangent: 256 at 20 degrees, 512 and 1024 at wider cones.
  const double narrow = std::tan(glm::radians(20.0));
  const SharedScene lit_by = with_hard_lights(*lab.engine().scene("water-tower"));
  const auto under = [&](double tangent) {
    Scene scene = *lit_by;
    scene.lights.front().outer_angle = glm::degrees(std::atan(tangent));
    scene.lights.front().inner_angle = scene.lights.front().outer_angle - 0.5;
    return with_hard_lights(std::move(scene));
  };
  const RenderResult truth = lab.draw(under(narrow), "water-tower", one_ray);
  Outcome outcome;
  std::vector<double> same, other;
  for (const int factor : {1, 2, 3}) {
    const auto error = [&](int map_size) {
      const RenderResult drawn = lab.draw(under(narrow * factor), "water-tower",
                                          "pcf-bilinear:map_size=" + std::to_string(map_size));
      // Judged is what the narrow cone lights.
      return metrics::visibility_error(drawn.visibility, truth.visibility, truth.judged).rms;
    };
    same.push_back(error(256 * factor));
    other.push_back(error(256));
    outcome.number(
        "rms, 256 x " + std::to_string(factor) + " texels, tangent x " + std::to_string(factor),
        same.back());
    outcome.number("rms, 256 texels, tangent x " + std::to_string(factor), other.back());
  }
  const auto [least, most] = std::minmax_element(same.begin(), same.end());
  outcome.part(*most < 1.1 * *least);
  outcome.part(other.back() > 1.1 * other.front());
  return outcome;
}

Outcome q26(Laboratory& lab) {
  const SharedScene trees = with_hard_lights(*lab.engine().scene("trees"));
  const RenderResult truth = lab.draw(trees, "trees", one_ray);
  Outcome outcome;
  // Rows below three quarters of the picture are the ground within some 12 m, those above 0.45
  // that beyond 30 m.
  const auto near_and_far = [&](const std::string& technique) {
    const RenderResult drawn = lab.draw(trees, "trees", technique);
    const std::pair errors(error_in_rows(drawn, truth, 0.75, 1.0),
                           error_in_rows(drawn, truth, 0.0, 0.45));
    outcome.number("near, " + technique, errors.first);
    outcome.number("far, " + technique, errors.second);
    return errors;
  };
  const auto plain = near_and_far("shadow-map:map_size=512");
  const auto focused = near_and_far("shadow-map:map_size=512:focus=seen");
  const auto warped = near_and_far("shadow-map:map_size=512:layout=perspective");
  outcome.part(warped.first < plain.first && warped.first < focused.first);
  outcome.part(warped.second > focused.second);
  // A near light is a spot lamp.
  const SharedScene tower = with_hard_lights(*lab.engine().scene("water-tower"));
  const RenderResult lit = lab.draw(tower, "water-tower", one_ray);
  const auto gain = [&](const SharedScene& scene, const RenderResult& right, const char* label) {
    const std::string map = "shadow-map:map_size=512:layout=perspective:cube_clipping=";
    const double with = error_to(lab.draw(scene, label, map + "true"), right);
    const double without = error_to(lab.draw(scene, label, map + "false"), right);
    outcome.number(std::string("error with cube clipping over without, ") + label, with / without);
    return with / without;
  };
  outcome.part(gain(tower, lit, "water-tower") < gain(trees, truth, "trees"));
  return outcome;
}

Outcome q33(Laboratory& lab) {
  Outcome outcome;
  double worst = 0.0, best = 1e9;
  for (int step = 0; step < 8; ++step) {
    Scene turned = *lab.engine().scene("trees");
    Camera& camera = turned.cameras.front();
    const double angle = glm::radians(45.0 * step);
    camera.position = {0.0, 3.0, -20.0};
    camera.target = camera.position + glm::dvec3(std::sin(angle), -0.12, std::cos(angle));
    const SharedScene scene = with_hard_lights(std::move(turned));
    const RenderResult truth = lab.draw(scene, "trees", one_ray);
    const double ratio =
        error_to(lab.draw(scene, "trees", "shadow-map:layout=perspective"), truth) /
        error_to(lab.draw(scene, "trees", "shadow-map:focus=seen"), truth);
    worst = std::max(worst, ratio);
    best = std::min(best, ratio);
  }
  outcome.number("error over that of a plain focused map, worst view", worst);
  outcome.number("best view", best);
  outcome.part(worst > 1.5);
  return outcome;
}

Outcome q47(Laboratory& lab) {
  const SharedScene scene = with_hard_lights(beam_behind_camera());
  const RenderResult truth = lab.draw(scene, "beam", one_ray);
  const std::string map = "shadow-map:layout=perspective:virtual_camera=";
  const double with = lost_inside(lab.draw(scene, "beam", map + "true"), truth);
  const double without = lost_inside(lab.draw(scene, "beam", map + "false"), truth);
  Outcome outcome;
  outcome.number("lost with a virtual camera", with);
  outcome.number("without", without);
  outcome.part(with == 0.0);
  outcome.part(without > 0.5);
  return outcome;
}

}  // namespace

std::vector<Claim> layout_claims() {
  return {
      {"Q26", "S4 fig. 29, 32",
       "perspective maps beat plain ones near the camera and lose far away; cube clipping helps "
       "most for near lights",
       "error near the camera below that of a plain map, focused or not; far away above the "
       "focused "
       "one's; cube clipping lowers a lamp's error by more than a sun's",
       q26},
      {"Q33", "S4", "perspective maps are sometimes much worse than plain ones",
       "over 1.5 times the error of a plain focused map in the worst of 8 views", q33},
      {"Q38", "S3 2.1.1, S1 2.1",
       "a map of what the camera sees loses shadows of casters behind it; fitting keeps them",
       "of the pixels inside such a shadow each layout loses none; left out, all are lost", q38},
      {"Q39", "S3 2.1.1", "focused maps flicker at borders when camera or light moves",
       "points that change beyond those of exact shadows, not snapped, camera: over 0.002; snapped "
       "below a quarter of that; light: over 0.002",
       q39},
      {"Q42", "S3 3.3.3, fig. 4.5", "wider blurs need fewer mip levels",
       "share of pixels at level 0 grows from 1 to 3 to 7 texels", q42},
      {"Q45", "S1 2.2, 2.3",
       "warping gains most with light across the view and is a plain map along it; partition does "
       "not hang on it",
       "error over a plain focused map's of the same bytes: each warp's at 90 degrees below that "
       "at "
       "12; which is 1 within 15%; the cascades' within a factor of 1.5",
       q45},
      {"Q46", "S4 fig. 52, 53", "quality follows map size over the tangent of the cone",
       "error of water-tower stays within 10% where both grow 3 times; grows by more where only "
       "the "
       "tangent does",
       q46},
      {"Q47", "S4 4.2.5, fig. 26, 27",
       "without a virtual camera perspective maps miss casters behind the camera",
       "pixels inside their shadow that are lost: none with it; over half without", q47},
  };
}

}  // namespace penumbra::experiments::claims
