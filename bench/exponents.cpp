// How the cost of a frame grows: bench_exponents [TECHNIQUE...] [--only NAME,...] [--frames N]
// [--repeats N] [--device NAME]. For every technique and everything that a scene or a request may
// have more of, three amounts, each twice the one before, and the exponent of a power law through
// the last two: 1 is linear. On a processor the time is what the process has worked, on a GPU the
// device's.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/frame_cost.h"
#include "bench/program.h"
#include "renderer/error.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;

struct Options {
  std::vector<std::string> techniques;
  std::vector<std::string> only;
  std::uint32_t frames = 4;
  std::uint32_t repeats = 3;
  std::string device;
};

struct Quantity {
  std::string name;
  std::vector<std::uint32_t> edges;  ///< or counts
  double power = 1.0;                ///< of the amount, over these
  /// False where a technique has no such thing.
  std::function<bool(RenderRequest&, std::uint32_t)> set;
};

bool set_scene(RenderRequest& request, std::uint32_t objects, std::uint32_t triangles,
               std::uint32_t lights) {
  request.scene = scenes::load("sweep:" + std::to_string(objects) + "x" +
                               std::to_string(triangles) + "x" + std::to_string(lights));
  return true;
}

bool set_parameter(RenderRequest& request, const std::string& name, std::uint32_t value) {
  for (const Parameter& parameter : request.technique->parameters)
    if (parameter.name == name) {
      request.parameters[name] = checked_value(parameter, std::to_string(value));
      return true;
    }
  return false;
}

std::vector<Quantity> quantities() {
  return {{"objects",
           {25, 50, 100},
           1.0,
           [](RenderRequest& r, std::uint32_t n) { return set_scene(r, n, 100, 1); }},
          {"triangles",
           {800, 1600, 3200},
           1.0,
           [](RenderRequest& r, std::uint32_t n) { return set_scene(r, 10, n, 1); }},
          {"lights",
           {2, 4, 8},
           1.0,
           [](RenderRequest& r, std::uint32_t n) { return set_scene(r, 10, 100, n); }},
          {"pixels",
           {200, 400, 800},
           2.0,
           [](RenderRequest& r, std::uint32_t n) {
             r.width = r.height = n;
             return true;
           }},
          {"texels",
           {512, 1024, 2048},
           2.0,
           [](RenderRequest& r, std::uint32_t n) { return set_parameter(r, "map_size", n); }},
          {"rays",
           {16, 32, 64},
           1.0,
           [](RenderRequest& r, std::uint32_t n) { return set_parameter(r, "rays", n); }},
          {"light samples", {64, 128, 256}, 1.0, [](RenderRequest& r, std::uint32_t n) {
             r.light_samples = n;
             return r.technique->family == "truth";
           }}};
}

/// Milliseconds of a frame; none where the technique refuses.
std::optional<double> frame_ms(Renderer& renderer, const RenderRequest& request,
                               const Options& options) {
  try {
    renderer.render(request);  // compiles shaders, uploads the scene
    std::vector<double> times;
    for (std::uint32_t turn = 0; turn < options.repeats; ++turn) {
      const bench::FrameCost frame = bench::frame_cost(renderer, request, options.frames);
      times.push_back(renderer.device().type == "cpu" ? frame.worked_ms : frame.cost.median_ms);
    }
    return bench::median(times);
  } catch (const Error& error) {
    std::fprintf(stderr, "%s: %s\n", request.technique->id.c_str(), error.what());
    return std::nullopt;
  }
}

void print_cell(Renderer& renderer, const RenderRequest& usual, const Quantity& quantity,
                const Options& options) {
  std::vector<double> times;
  for (const std::uint32_t edge : quantity.edges) {
    RenderRequest request = usual;
    if (!quantity.set(request, edge)) break;
    const auto time = frame_ms(renderer, request, options);
    if (!time) break;
    times.push_back(*time);
  }
  if (times.size() < quantity.edges.size()) {
    std::printf(" - |");
    return;
  }
  const std::size_t last = times.size() - 1;
  const double amount = std::log(static_cast<double>(quantity.edges[last]) /
                                 static_cast<double>(quantity.edges[last - 1]));
  std::printf(" %.2f (%.1f, %.1f, %.1f) |",
              std::log(times[last] / times[last - 1]) / (quantity.power * amount), times[0],
              times[1], times[2]);
}

void run(const Options& options) {
  Renderer renderer({.device = options.device});
  std::vector<Quantity> asked;
  for (Quantity& quantity : quantities())
    if (options.only.empty() ||
        std::find(options.only.begin(), options.only.end(), quantity.name) != options.only.end())
      asked.push_back(std::move(quantity));
  std::vector<std::string> ids = options.techniques;
  if (ids.empty())
    for (const TechniqueDescription& technique : techniques::all()) ids.push_back(technique.id);
  std::printf("%s, median of %u turns of %u frames; exponent (ms of the three amounts)\n\n",
              renderer.device().name.c_str(), options.repeats, options.frames);
  std::printf("| technique |");
  for (const Quantity& quantity : asked) {
    std::printf(" %s", quantity.name.c_str());
    for (const std::uint32_t edge : quantity.edges)
      std::printf(quantity.power > 1.0 ? " %u^2" : " %u", edge);
    std::printf(" |");
  }
  std::printf("\n|---|");
  for (std::size_t i = 0; i < asked.size(); ++i) std::printf("---|");
  for (const std::string& id : ids) {
    const auto resolved = techniques::resolve(id);
    RenderRequest usual;
    usual.technique = resolved.technique;
    usual.parameters = resolved.parameters;
    usual.width = usual.height = 200;
    usual.light_samples = 64;
    set_scene(usual, 10, 100, 1);
    std::printf("\n| `%s` |", id.c_str());
    for (const Quantity& quantity : asked) {
      print_cell(renderer, usual, quantity, options);
      std::fflush(stdout);
    }
  }
  std::printf("\n");
}

}  // namespace

int main(int count, char** values) {
  Options options;
  return penumbra::bench::run_program(
      count, values, "How the cost of a frame grows",
      [&](CLI::App& app) {
        app.add_option("techniques", options.techniques, "Ids of techniques or presets; all");
        app.add_option("--only", options.only, "Quantities")->delimiter(',');
        app.add_option("--frames", options.frames, "Frames of a turn")->check(CLI::PositiveNumber);
        app.add_option("--repeats", options.repeats, "Turns")->check(CLI::PositiveNumber);
        penumbra::bench::add_device_option(app, options.device);
      },
      [&] { run(options); });
}
