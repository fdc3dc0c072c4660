#include "experiments/claims/hard_light.h"

#include <cmath>

#include "renderer/metrics/metrics.h"
#include "renderer/scene/light_points.h"

namespace penumbra::experiments::claims {

SharedScene with_hard_lights(Scene scene) {
  for (Light& light : scene.lights) light.extent = {};
  return std::make_shared<const Scene>(std::move(scene));
}

FixedAxes axes_of(const Light& light) {
  const WorldLight world = world_light(light, glm::dvec3(0.0));
  return {glm::cross(world.direction, world.up), world.up, world.direction};
}

double error_in_rows(const RenderResult& drawn, const RenderResult& truth, double first,
                     double end) {
  ImageF judged = drawn.judged;
  for (std::uint32_t y = 0; y < judged.height; ++y) {
    const double place = (y + 0.5) / judged.height;
    if (place >= first && place < end) continue;
    for (std::uint32_t x = 0; x < judged.width; ++x) judged.at(x, y, 0) = 0.0f;
  }
  return metrics::visibility_error(drawn.visibility, truth.visibility, judged).rms;
}

double error_to(const RenderResult& drawn, const RenderResult& truth) {
  return error_in_rows(drawn, truth, 0.0, 1.0);
}

namespace {

/// The village from straight above, a number of pixels of 300 to the right; its sun turned,
/// degrees.
SharedScene village_from_above(Laboratory& lab, int pixels, double light_turn) {
  Scene scene = seen_from(*lab.engine().scene("village"), {.light_turn = light_turn});
  Camera& camera = scene.cameras.front();
  camera.projection = Projection::orthographic;
  camera.orthographic_height = 20.0;
  const double right = 20.0 * pixels / lab.scale().size;
  camera.position = {right, 30.0, 0.0};
  camera.target = {right, 0.0, 0.0};
  camera.up = {0.0, 0.0, -1.0};
  scene.cameras.resize(1);
  return with_hard_lights(std::move(scene));
}

/// Share of the surface points in two pictures, the second of a camera `pixels` to the right, whose
/// visibility differs.
double changed_share(const RenderResult& first, const RenderResult& second, std::uint32_t pixels) {
  std::size_t compared = 0, changed = 0;
  for (std::uint32_t y = 0; y < first.visibility.height; ++y)
    for (std::uint32_t x = pixels; x < first.visibility.width; ++x) {
      if (first.judged.at(x, y, 0) < 0.5f || second.judged.at(x - pixels, y, 0) < 0.5f) continue;
      ++compared;
      changed +=
          std::abs(first.visibility.at(x, y, 0) - second.visibility.at(x - pixels, y, 0)) > 0.01f;
    }
  return compared == 0 ? 0.0 : static_cast<double>(changed) / static_cast<double>(compared);
}

}  // namespace

double flicker(Laboratory& lab, const std::string& technique, bool light_moves) {
  constexpr int frames = 6, step = 5;
  double sum = 0.0;
  RenderResult before;
  for (int frame = 0; frame < frames; ++frame) {
    const int pixels = light_moves ? 0 : frame * step;
    RenderResult now = lab.draw(village_from_above(lab, pixels, light_moves ? 0.5 * frame : 0.0),
                                "village from above", technique);
    if (frame > 0) sum += changed_share(before, now, light_moves ? 0 : step);
    before = std::move(now);
  }
  return sum / (frames - 1);
}

}  // namespace penumbra::experiments::claims
