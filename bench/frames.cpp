// Processor time of frames of a scene: bench_frames SCENE TECHNIQUE... [--width N] [--height N]
// [--frames N] [--repeats N] [--camera NAME] [--set NAME=VALUE]. SCENE is an id or a file, so that
// a scene written down from another program can be drawn beside it. Times of the process, with all
// its threads, hardly move with what else the machine does; they are what is compared. Techniques
// take turns, and the median of all turns is printed: a frame, what it costs over the first
// technique named, and device milliseconds of its passes.
#include <cstdio>
#include <string>
#include <vector>

#include "bench/frame_cost.h"
#include "bench/program.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;
using namespace penumbra::bench;

struct Options {
  std::string scene;
  std::vector<std::string> techniques;
  std::vector<std::string> settings;
  std::string camera;
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
  std::uint32_t supersampling = 1;
  std::uint32_t frames = 20;
  std::uint32_t repeats = 5;
  std::string device;
};

struct Row {
  RenderRequest request;
  std::vector<double> worked;  ///< ms a frame, a turn each
  Cost cost;                   ///< of the last turn
};

/// Settings that a technique does not have are left out of its request.
void apply(const std::vector<std::string>& settings, RenderRequest& request) {
  for (const std::string& setting : settings) {
    const std::size_t mark = setting.find('=');
    if (mark == std::string::npos) throw std::invalid_argument("not NAME=VALUE: " + setting);
    const std::string name = setting.substr(0, mark);
    for (const Parameter& parameter : request.technique->parameters)
      if (parameter.name == name)
        request.parameters[name] = checked_value(parameter, setting.substr(mark + 1));
  }
}

void run(const Options& options) {
  Renderer renderer({.device = options.device});
  std::vector<Row> rows;
  RenderRequest request;
  request.scene = scenes::load(options.scene);
  request.camera = options.camera;
  request.width = options.width;
  request.height = options.height;
  request.supersampling = options.supersampling;
  for (const std::string& name : options.techniques) {
    const auto resolved = techniques::resolve(name);
    request.technique = resolved.technique;
    request.parameters = resolved.parameters;
    apply(options.settings, request);
    rows.push_back({request, {}, {}});
    renderer.render(request);  // compiles shaders
  }
  for (std::uint32_t turn = 0; turn < options.repeats; ++turn)
    for (Row& row : rows) {
      FrameCost frame = frame_cost(renderer, row.request, options.frames);
      row.worked.push_back(frame.worked_ms);
      row.cost = std::move(frame.cost);
    }
  std::printf("%s, %s, %ux%u, median of %u turns of %u frames\n", renderer.device().name.c_str(),
              options.scene.c_str(), options.width, options.height, options.repeats,
              options.frames);
  std::printf(
      "\n| technique | CPU ms a frame | over the first | passes, ms |\n|---|---|---|---|\n");
  const double first = median(rows.front().worked);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double own = median(rows[i].worked);
    std::printf("| `%s` | %.2f | %.2f |", options.techniques[i].c_str(), own, own - first);
    for (const PassCost& pass : rows[i].cost.passes)
      std::printf(" %s %.2f", pass.name.c_str(), pass.median_ms);
    std::printf(" |\n");
  }
}

}  // namespace

int main(int count, char** values) {
  Options options;
  return run_program(
      count, values, "Processor time of frames of a scene",
      [&](CLI::App& app) {
        app.add_option("scene", options.scene, "Id of a scene, or a file")->required();
        app.add_option("techniques", options.techniques, "Ids of techniques or presets")
            ->required();
        app.add_option("--set", options.settings, "Parameter of those techniques that have it");
        app.add_option("--camera", options.camera,
                       "Name of a camera; the scene's first by default");
        app.add_option("--width", options.width, "Pixels");
        app.add_option("--height", options.height, "Pixels");
        app.add_option("--supersampling", options.supersampling, "Samples of a pixel");
        app.add_option("--frames", options.frames, "Frames of a turn")->check(CLI::PositiveNumber);
        app.add_option("--repeats", options.repeats, "Turns")->check(CLI::PositiveNumber);
        add_device_option(app, options.device);
      },
      [&] { run(options); });
}
