// Claims about shadow volumes and the hybrid of volumes and maps.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <regex>
#include <string>

#include "experiments/claims/claim.h"
#include "experiments/claims/hard_light.h"
#include "experiments/claims/laboratory.h"
#include "experiments/report/rows.h"
#include "scenes/generators/scene_builder.h"

namespace penumbra::experiments::claims {
namespace {

/// A visibility_rms below this is what sampling leaves along edges of exact hard shadows.
constexpr double exact_rms = 0.02;

double hard_rms(Laboratory& lab, const std::string& scene, const std::string& technique) {
  return lab.value("visibility_rms", scene, technique, Truth::hard);
}

Outcome q01(Laboratory& lab) {
  const std::string scene = "camera-in-volume";
  Outcome outcome;
  const double before = hard_rms(lab, scene, "shadow-volumes-zpass");
  outcome.number("z-pass", before);
  outcome.part(before > 0.2);
  for (const char* id : {"shadow-volumes", "shadow-volumes-zpass-plus"}) {
    const double rms = hard_rms(lab, scene, id);
    outcome.number(id, rms);
    outcome.part(rms < exact_rms);
  }
  return outcome;
}

Outcome q02(Laboratory& lab) {
  Outcome outcome;
  const double right = hard_rms(lab, "three-layers", "shadow-volumes");
  outcome.number("infinite, capped", right);
  outcome.part(right < exact_rms);
  for (const std::string ablation : {"far-clipped", "uncapped"}) {
    const double rms = hard_rms(lab, "three-layers", "shadow-volumes:ablation=" + ablation);
    outcome.number(ablation, rms);
    outcome.part(rms > 0.1);
  }
  return outcome;
}

Outcome q27(Laboratory& lab) {
  const double volumes = hard_rms(lab, "boxes", "shadow-volumes");
  Outcome outcome;
  outcome.number("volumes", volumes);
  double last = 2.0, rms = 0.0;
  bool falling = true;
  for (const char* size : {"64", "256", "1024"}) {
    rms = hard_rms(lab, "boxes", std::string("hybrid:map_size=") + size);
    outcome.number(std::string("hybrid, map ") + size, rms);
    falling = falling && rms <= last;
    last = rms;
  }
  outcome.part(falling);
  outcome.part(rms - volumes < exact_rms);
  return outcome;
}

Outcome q32(Laboratory& lab) {
  const std::string biasless = "bias=0:slope_scale=0:bias_strategy=constant";
  const auto acne = [&](const std::string& technique) {
    return lab.value("false_shadow", "boxes", technique, Truth::hard);
  };
  const double map = acne("shadow-map:" + biasless), hybrid = acne("hybrid:" + biasless);
  const double volumes = acne("shadow-volumes");
  Outcome outcome;
  outcome.number("false_shadow of the map", map);
  outcome.number("of the hybrid", hybrid);
  outcome.number("of volumes", volumes);
  outcome.part(map > 0.01);
  outcome.part(hybrid < 0.1 * map);
  return outcome;
}

/// A box over the ground, with a hole in its lower side or closed.
SharedScene floating_box(bool closed) {
  scenes::SceneBuilder b("box", "A box over the ground");
  b.ground({-4.0, -4.0}, {4.0, 4.0}, b.look("grey", glm::vec3(0.7f)));
  scenes::Solid box = scenes::box({-0.8, 0.6, -0.8}, {0.8, 1.6, 0.8});
  // Both triangles of the lower side go.
  if (!closed)
    std::erase_if(box.triangles, [&](const auto& triangle) {
      return std::all_of(triangle.begin(), triangle.end(),
                         [&](std::uint32_t corner) { return box.points[corner].y < 0.7; });
    });
  b.place(box, b.look("red", glm::vec3(0.5f)), "box");
  b.spot("lamp", {1.0, 5.0, 0.7}, {0.0, 0.5, 0.0}, glm::vec3(1.0f), 1.0f, 50.0, LightExtent{});
  b.camera("main", {0.0, 3.5, 5.0}, {0.0, 0.6, 0.0}, 45.0);
  return std::make_shared<const Scene>(std::move(b.scene));
}

/// Share of all wrong pixels (by more than 0.5) that lie where a picture of the truth is dark.
double share_in_shadow(const RenderResult& drawn, const RenderResult& truth) {
  double wrong = 0.0, in_shadow = 0.0;
  for (std::size_t i = 0; i < truth.visibility.pixels.size(); ++i) {
    const float real = truth.visibility.pixels[i];
    if (truth.judged.pixels[i] < 0.5f || std::abs(drawn.visibility.pixels[i] - real) < 0.5f)
      continue;
    wrong += 1.0;
    in_shadow += real < 0.5f;
  }
  return wrong > 0.0 ? in_shadow / wrong : 0.0;
}

Outcome q03(Laboratory& lab) {
  const SharedScene closed = floating_box(true), open = floating_box(false);
  const RenderResult truth = lab.draw(closed, "closed box", one_ray);
  const RenderResult truth_open = lab.draw(open, "box with a hole", one_ray);
  Outcome outcome;
  for (const std::string technique :
       {"shadow-volumes:ablation=gaps-ignored", "shadow-volumes-zpass",
        "shadow-map:bias_strategy=back-faces:map_size=1024"}) {
    const RenderResult leaking = lab.draw(open, "box with a hole", technique);
    const double before = error_to(lab.draw(closed, "closed box", technique), truth);
    const double after = error_to(leaking, truth_open);
    outcome.number("closed, " + technique, before);
    outcome.number("with a hole, " + technique, after);
    outcome.number("of it in the shadow, " + technique, share_in_shadow(leaking, truth_open));
    outcome.part(after > 2.0 * before && after > exact_rms);
  }
  outcome.number("shadow-volumes, which find holes",
                 error_to(lab.draw(open, "box with a hole", "shadow-volumes"), truth_open));
  return outcome;
}

/// A slab of many triangles whose upper side a lamp beside it looks along: rounding decides which
/// of them it lights. The camera sees its lower side, which is dark in any case.
SharedScene slab_edge_on() {
  scenes::SceneBuilder b("slab", "A slab, edge on");
  b.ground({-6.0, -6.0}, {6.0, 6.0}, b.look("grey", glm::vec3(0.7f)));
  constexpr int columns = 17;
  const auto slab = scenes::height_field({-0.8, -0.8}, {0.8, 0.8}, columns,
                                         std::vector<double>(columns * columns, 0.0), -0.1);
  const glm::dmat4 turned =
      glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 1.5, 0.0)) *
      glm::rotate(glm::dmat4(1.0), 0.9, glm::normalize(glm::dvec3(0.3, 0.2, 1.0)));
  b.place(slab, b.look("red", glm::vec3(0.5f)), "slab", turned);
  const glm::dvec3 lamp(turned * glm::dvec4(1.3, 0.0, 0.17, 1.0));
  b.spot("lamp", lamp, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 75.0, LightExtent{});
  b.camera("main", {5.0, 3.0, 2.0}, {0.0, 0.4, 0.0}, 60.0);
  return std::make_shared<const Scene>(std::move(b.scene));
}

Outcome q04(Laboratory& lab) {
  const SharedScene scene = slab_edge_on();
  const RenderResult truth = lab.draw(scene, "slab edge on", one_ray);
  const auto error = [&](const char* technique) {
    return error_to(lab.draw(scene, "slab edge on", technique), truth);
  };
  Outcome outcome;
  const double planes = error("shadow-volumes");
  const double corners = error("shadow-volumes:ablation=first-corner");
  outcome.number("by the triangle's plane", planes);
  outcome.number("by its first corner", corners);
  outcome.part(planes < exact_rms);
  outcome.part(corners > 0.05);
  return outcome;
}

double time_ratio(Laboratory& lab, const std::string& scene, const std::string& a,
                  const std::string& b) {
  return lab.value("frame_ms", scene, a) / lab.value("frame_ms", scene, b);
}

Outcome c03(Laboratory& lab) {
  const std::string low = "sweep:10x100x1", high = "sweep:10x1600x1";
  Outcome outcome;
  double growth[2] = {};
  const char* ids[2] = {"shadow-volumes-zpass", "shadow-map"};
  for (int i = 0; i < 2; ++i) {
    growth[i] = lab.value("frame_ms", high, ids[i]) / lab.value("frame_ms", low, ids[i]);
    outcome.number(std::string(ids[i]) + ", 1600 over 100 triangles", growth[i]);
  }
  outcome.part(growth[0] > 1.5 * growth[1]);
  return outcome;
}

Outcome c04(Laboratory& lab) {
  const std::string scene = "sweep:10x1600x1";
  Outcome outcome;
  const double behind = time_ratio(lab, scene, "shadow-volumes", "shadow-volumes-zpass");
  const double soft = time_ratio(lab, scene, "soft-shadow-volumes-2007", "shadow-volumes");
  outcome.number("z-fail over z-pass", behind);
  outcome.number("soft over z-fail", soft);
  outcome.part(behind > 1.0);
  outcome.part(soft > 1.0);
  return outcome;
}

Outcome c05(Laboratory& lab) {
  need_stencil_fragments(lab);
  const std::string scene = "sweep:10x1600x1";
  const double silhouettes =
      sum_over_passes(lab.row(scene, "shadow-volumes"), "volumes", "fragments");
  const double all_triangles =
      sum_over_passes(lab.row(scene, "shadow-volumes-brute-force"), "volumes", "fragments");
  Outcome outcome;
  outcome.number("fragments of silhouette volumes", silhouettes);
  outcome.number("of brute force", all_triangles);
  outcome.number("ratio", all_triangles / silhouettes);
  outcome.part(all_triangles > 2.0 * silhouettes);
  return outcome;
}

Outcome c08(Laboratory& lab) {
  const double ratio = time_ratio(lab, "sweep:10x1600x1", "shadow-volumes:stencil_passes=2",
                                  "shadow-volumes:stencil_passes=1");
  Outcome outcome;
  outcome.number("two passes over one", ratio);
  outcome.part(ratio > 1.0);
  return outcome;
}

Outcome c12(Laboratory& lab) {
  // The hybrid counts what passes its mask; pipeline statistics count what the mask rejects too.
  static const std::regex share("draw ([0-9.]+) % of their fragments");
  Outcome outcome;
  for (const std::string scene : {"boxes", "teapot"})
    for (const std::string& note : lab.draw(scene, "hybrid").notes) {
      std::smatch found;
      if (!std::regex_search(note, found, share)) continue;
      outcome.number("percent of volumes' fragments, " + scene, std::stod(found[1]));
      outcome.part(std::stod(found[1]) < 25.0);
    }
  return outcome;
}

}  // namespace

std::vector<Claim> volume_claims() {
  return {
      {"Q01", "S0 2.4, S4 fig. 21",
       "z-pass volumes invert with the camera inside a volume; z-fail and z-pass+ do not",
       "visibility_rms to exact rays on camera-in-volume over 0.2 for z-pass; below 0.02 for "
       "z-fail; for z-pass+",
       q01},
      {"Q02", "S0, S4 3.2.5", "uncapped or far-clipped z-fail is wrong, infinite extrusion right",
       "on three-layers below 0.02 as is; over 0.1 far-clipped; over 0.1 uncapped", q02},
      {"Q03", "S0 fig. 2.13, 3.4",
       "casters that are not watertight leak in silhouette volumes and in maps of back faces",
       "a hole in the lower side of a box more than doubles the error, to over 0.02, of volumes "
       "that take it for closed; of z-pass; of back faces",
       q03},
      {"Q04", "S0", "whether a triangle is lit must be one answer for each triangle",
       "on a slab seen edge on by the lamp: error below 0.02 by its plane; over 0.05 by its first "
       "corner",
       q04},
      {"Q27", "S4 fig. 56",
       "the hybrid matches volumes except where a small map misses a thin caster",
       "its error falls with map size; at 1024 within 0.02 of volumes", q27},
      {"Q32", "S4 fig. 43", "the hybrid removes the map's acne",
       "without bias the map's false_shadow is over 0.01; the hybrid's below a tenth of it", q32},
      {"C03", "S0 4.2.1", "volumes suffer from many triangles, maps far less",
       "volumes' time grows over 1.5 times as much as the map's from 100 to 1600 triangles", c03,
       Needs::gpu},
      {"C04", "S0 4.2.1", "z-fail is slower than z-pass, soft volumes slower than both",
       "z-fail over z-pass above 1; soft over z-fail above 1", c04, Needs::gpu},
      {"C05", "S0 2.4.1", "brute-force volumes draw many times the fragments of silhouettes",
       "fragments counted: over twice as many", c05},
      {"C08", "S4 3.2", "a two-sided stencil beats two passes", "two passes take longer", c08,
       Needs::gpu},
      {"C12", "S4 fig. 39", "the hybrid draws a small share of volumes' fragments",
       "those that pass its mask: below a quarter on boxes; on teapot", c12},
  };
}

}  // namespace penumbra::experiments::claims
