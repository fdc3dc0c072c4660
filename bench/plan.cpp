// What each rule of the plan saves: bench_plan [WIDTH]. Every row is a scene as it was composed, or
// seen through a lens four times as long, with one rule off against all rules on, in one process:
// bytes of the scene on the device, vertices assembled in a frame, milliseconds of a fresh
// renderer's first frame, and milliseconds of a frame (median of 9). A second table has the error
// of maps with their depth fitted to what matters, and not.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bench/program.h"
#include "renderer/metrics/metrics.h"
#include "renderer/plan/plan.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;

struct Figures {
  double mebibytes = 0.0;      ///< of geometry and textures that the plan keeps
  std::uint64_t vertices = 0;  ///< assembled in a frame
  double create_ms = 0.0;
  double frame_ms = 0.0;
};

Figures measure(RenderRequest request) {
  Figures figures;
  const Plan plan =
      make_plan(request, complete_parameters(request.technique->parameters, request.parameters),
                instance_boxes(*request.scene));
  for (const PlanLine& line : plan.lines)
    if (line.kept) figures.mebibytes += static_cast<double>(line.bytes) / (1 << 20);
  Renderer renderer({});
  request.frames = 9;
  const Cost cost = renderer.render(request).cost;
  for (const PassCost& pass : cost.passes) figures.vertices += pass.vertices;
  figures.create_ms = cost.create_ms;
  figures.frame_ms = cost.median_ms;
  return figures;
}

/// Error of hard shadows against rays with depth fitted and not: nothing is saved, something
/// gained.
void print_depth_range(std::uint32_t width) {
  std::printf(
      "\n| scene | technique | false + missing shadow, fitted | from end to end of the scene |\n");
  std::printf("|---|---|---|---|\n");
  Renderer renderer({});
  for (const char* id :
       {"car", "boxes", "disco-box", "island", "warehouse-inside", "warehouse-outside"})
    for (const char* technique : {"shadow-map", "esm-log"}) {
      const auto resolved = techniques::resolve(technique);
      RenderRequest request;
      request.scene = scenes::load(id);
      request.technique = resolved.technique;
      request.parameters = resolved.parameters;
      if (technique == std::string("shadow-map"))
        request.parameters["depth_bits"] = std::string("16");
      request.width = request.height = width;
      request.visibility = true;
      RenderRequest truth = request;
      truth.technique = techniques::resolve("ray-traced").technique;
      truth.parameters = {};
      const RenderResult exact = renderer.render(truth);
      const auto error = [&] {
        const RenderResult result = renderer.render(request);
        const auto measured =
            metrics::visibility_error(result.visibility, exact.visibility, result.judged);
        return measured.false_shadow + measured.missing_shadow;
      };
      const double fitted = error();
      request.rules.depth_range = false;
      std::printf("| %s | %s%s | %.5f | %.5f |\n", id, technique,
                  request.parameters.contains("depth_bits") ? ", 16 bits" : "", fitted, error());
      std::fflush(stdout);
    }
}

void print_rules(std::uint32_t width) {
  std::printf("device: %s\n\n", Renderer({}).device().name.c_str());
  std::printf(
      "| scene | lens | technique | rule off | MiB | vertices | first frame ms | frame ms |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (const char* id : {"warehouse-outside", "sweep:100x1600x2"})
    for (const double lens : {1.0, 4.0})
      for (const char* technique : {"none", "shadow-map", "shadow-volumes", "ray-traced"}) {
        Scene scene = *scenes::load(id);
        scene.cameras.front().vertical_fov /= lens;
        RenderRequest request;
        request.scene = std::make_shared<const Scene>(std::move(scene));
        request.technique = techniques::resolve(technique).technique;
        request.width = request.height = width;
        const auto print = [&](const char* off) {
          const Figures figures = measure(request);
          std::printf("| %s | %.0fx | %s | %s | %.2f | %llu | %.0f | %.1f |\n", id, lens, technique,
                      off, figures.mebibytes, static_cast<unsigned long long>(figures.vertices),
                      figures.create_ms, figures.frame_ms);
          std::fflush(stdout);
        };
        print("-");
        for (const auto& [name, rule] : lossless_rules) {
          request.rules = {};
          request.rules.*rule = false;
          print(name);
        }
        request.rules = {.lights = false, .surfaces = false, .casters = false, .textures = false};
        print("all");
      }
}

}  // namespace

int main(int count, char** values) {
  std::uint32_t width = 300;
  return bench::run_program(
      count, values, "What each rule of the plan saves",
      [&](CLI::App& app) {
        app.add_option("WIDTH", width, "Pixels, width and height")->check(CLI::PositiveNumber);
      },
      [&] {
        print_rules(width);
        print_depth_range(width);
      });
}
