// How near each layout comes to exact hard shadows at each distance, and how much of its error
// crawls when the camera moves: bench_layouts [--size N] [--scenes LIST] [--device NAME]
//
// Lights have no extents here. A pixel's distance is that at which its ray meets the ground: what
// stands on it is nearer. Every layout has the bytes of one map of 512x512 texels, but for tiles,
// which have 6.5 times as many.
#include <cmath>
#include <cstdio>

#include "bench/program.h"
#include "renderer/metrics/metrics.h"
#include "renderer/render.h"
#include "renderer/shadow_maps/layout.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;
using SharedScene = std::shared_ptr<const Scene>;

struct Options {
  std::uint32_t size = 256;
  std::vector<std::string> scenes = {"trees", "village", "town"};
  std::string device;
};

struct Subject {
  std::string name;
  ParameterValues parameters;
};

/// Every layout that serves a sun, and a single view focused on what is seen.
std::vector<Subject> subjects() {
  std::vector<Subject> list;
  for (const std::string& layout : shadow_maps::layouts_for(LightKind::directional)) {
    if (layout.starts_with("iasm-")) continue;  // other ways to the picture of iasm
    ParameterValues values{{"layout", layout}, {"map_size", std::int64_t{512}}};
    if (layout == "single") list.push_back({"single, focus scene", values});
    if (layout == "single") values["focus"] = std::string("seen");
    // Four cascades are as many bytes as one map of twice the width.
    if (layout.starts_with("cascaded")) values["map_size"] = std::int64_t{256};
    list.push_back({layout == "single" ? "single, focus seen" : layout, values});
  }
  return list;
}

RenderResult draw(Renderer& renderer, const SharedScene& scene, const std::string& technique,
                  const ParameterValues& parameters, std::uint32_t size) {
  const auto resolved = techniques::resolve(technique, parameters);
  RenderRequest request;
  request.scene = scene;
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.width = request.height = size;
  request.visibility = true;
  return renderer.render(request);
}

SharedScene with_hard_lights(const std::string& id) {
  Scene scene = *scenes::load(id);
  for (Light& light : scene.lights) light.extent = {};
  return std::make_shared<const Scene>(std::move(scene));
}

/// Distances in metres at which bands end.
constexpr double band_ends[] = {15.0, 30.0, 60.0, 1e9};
constexpr std::size_t bands = std::size(band_ends);

/// The band of the ground behind a pixel; `bands` above the horizon.
std::size_t band_of(const Camera& camera, std::uint32_t x, std::uint32_t y, std::uint32_t size) {
  const glm::dvec3 ahead = glm::normalize(camera.target - camera.position);
  const glm::dvec3 right = glm::normalize(glm::cross(ahead, camera.up));
  const glm::dvec3 up = glm::cross(right, ahead);
  const double tangent = std::tan(glm::radians(0.5 * camera.vertical_fov));
  const glm::dvec3 ray = ahead + tangent * ((2.0 * (x + 0.5) / size - 1.0) * right +
                                            (1.0 - 2.0 * (y + 0.5) / size) * up);
  if (ray.y >= 0.0) return bands;
  const double distance = camera.position.y / -ray.y;
  std::size_t band = 0;
  while (distance > band_ends[band]) ++band;
  return band;
}

double error_in_band(const RenderResult& result, const RenderResult& truth, const Camera& camera,
                     std::size_t band) {
  ImageF judged = result.judged;
  for (std::uint32_t y = 0; y < judged.height; ++y)
    for (std::uint32_t x = 0; x < judged.width; ++x)
      if (band_of(camera, x, y, judged.width) != band) judged.at(x, y, 0) = 0.0f;
  return metrics::visibility_error(result.visibility, truth.visibility, judged).rms;
}

void measure_bands(Renderer& renderer, const Options& options) {
  for (const std::string& id : options.scenes) {
    const SharedScene scene = with_hard_lights(id);
    const RenderResult truth =
        draw(renderer, scene, "ray-traced", {{"rays", std::int64_t{1}}}, options.size);
    for (const char* technique : {"shadow-map", "pcf-bilinear-3x3"}) {
      std::printf(
          "\n%s, `%s`:\n\n| layout | below 15 m | 15 to 30 m | 30 to 60 m | beyond | all |\n"
          "|---|---|---|---|---|---|\n",
          id.c_str(), technique);
      for (const Subject& subject : subjects()) {
        const RenderResult result =
            draw(renderer, scene, technique, subject.parameters, options.size);
        std::printf("| %s |", subject.name.c_str());
        for (std::size_t band = 0; band < bands; ++band)
          std::printf(" %.3f |", error_in_band(result, truth, scene->cameras[0], band));
        std::printf(
            " %.3f |\n",
            metrics::visibility_error(result.visibility, truth.visibility, result.judged).rms);
      }
    }
  }
}

/// The village from straight above, `pixels` to the right.
SharedScene from_above(const Scene& village, double pixels, std::uint32_t size) {
  Scene scene = village;
  Camera& camera = scene.cameras[0];
  camera.projection = Projection::orthographic;
  camera.orthographic_height = 20.0;
  const double right = 20.0 * pixels / size;
  camera.position = {right, 30.0, 0.0};
  camera.target = {right, 0.0, 0.0};
  camera.up = {0.0, 0.0, -1.0};
  return std::make_shared<const Scene>(std::move(scene));
}

/// Share of surface points that change between frames of a camera that moves by five pixels each.
double crawl(Renderer& renderer, const ParameterValues& parameters, const std::string& technique,
             std::uint32_t size) {
  constexpr int frames = 6, step = 5;
  const SharedScene village = with_hard_lights("village");
  double changed = 0.0, compared = 0.0;
  RenderResult before;
  for (int frame = 0; frame < frames; ++frame) {
    RenderResult now =
        draw(renderer, from_above(*village, frame * step, size), technique, parameters, size);
    for (std::uint32_t y = 0; frame > 0 && y < size; ++y)
      for (std::uint32_t x = step; x < size; ++x) {
        if (before.judged.at(x, y, 0) < 0.5f || now.judged.at(x - step, y, 0) < 0.5f) continue;
        compared += 1.0;
        changed +=
            std::abs(before.visibility.at(x, y, 0) - now.visibility.at(x - step, y, 0)) > 0.01f;
      }
    before = std::move(now);
  }
  return changed / compared;
}

void measure_crawl(Renderer& renderer, std::uint32_t size) {
  std::printf(
      "\nShare of points that change between two frames, village from above:\n\n"
      "| layout | changes |\n|---|---|\n");
  std::printf("| exact shadows | %.5f |\n",
              crawl(renderer, {{"rays", std::int64_t{1}}}, "ray-traced", size));
  for (const Subject& subject : subjects()) {
    const bool cascades = subject.parameters.at("layout") == ParameterValue("cascaded");
    for (const bool snapping : cascades ? std::vector{true, false} : std::vector{true}) {
      ParameterValues parameters = subject.parameters;
      if (cascades) parameters["cascade_snapping"] = snapping;
      std::printf("| %s%s | %.5f |\n", subject.name.c_str(),
                  !cascades  ? ""
                  : snapping ? ", snapped"
                             : ", not snapped",
                  crawl(renderer, parameters, "shadow-map", size));
    }
  }
}

}  // namespace

int main(int count, char** values) {
  Options options;
  return penumbra::bench::run_program(
      count, values, "Errors of layouts by distance, and how they crawl",
      [&](CLI::App& app) {
        penumbra::bench::add_size_option(app, options.size);
        app.add_option("--scenes", options.scenes, "Scenes under a sun")->delimiter(',');
        penumbra::bench::add_device_option(app, options.device);
      },
      [&] {
        penumbra::Renderer renderer({.device = options.device});
        std::printf("Device: %s (%s). %ux%u.\n", renderer.device().name.c_str(),
                    renderer.device().driver.c_str(), options.size, options.size);
        measure_bands(renderer, options);
        measure_crawl(renderer, options.size);
      });
}
