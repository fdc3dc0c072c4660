// What shadows from geometry cost over each other: bench_volumes_times [--part volumes|fleet|all]
// [--width N] [--frames N] [--rounds N] [--device NAME]
//
// Every round draws all variants of a scene one after another, and ratios are taken within a round,
// so that what else the machine does meanwhile meets both sides. Printed are the median over the
// rounds and, in brackets, the quartiles.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "bench/program.h"
#include "renderer/render.h"
#include "scenes/built_in/built_in.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;

struct Options {
  std::string part = "all";
  std::uint32_t width = 300;
  std::uint32_t frames = 5;
  int rounds = 9;
  std::string device;
};

struct Variant {
  const char* label;
  const char* technique;
  ParameterValues parameters;
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> list{
      {"z-pass", "shadow-volumes-zpass", {}},
      {"z-pass, two passes", "shadow-volumes-zpass", {{"stencil_passes", std::int64_t{2}}}},
      {"z-fail", "shadow-volumes", {}},
      {"z-fail, two passes", "shadow-volumes", {{"stencil_passes", std::int64_t{2}}}},
      {"z-fail, clamped", "shadow-volumes", {{"clamp", true}}},
      {"automatic", "shadow-volumes", {{"counting", std::string("automatic")}}},
      {"z-pass+", "shadow-volumes-zpass-plus", {}},
      {"soft", "soft-shadow-volumes", {}}};
  return list;
}

/// Claim and what is divided by what.
struct Ratio {
  const char* label;
  const char* over;
  const char* under;
};

constexpr Ratio ratios[] = {{"z-fail / z-pass (C04)", "z-fail", "z-pass"},
                            {"soft / z-fail (C04)", "soft", "z-fail"},
                            {"z-pass in two passes / one (C08)", "z-pass, two passes", "z-pass"},
                            {"z-fail in two passes / one (C08)", "z-fail, two passes", "z-fail"},
                            {"z-fail clamped / not", "z-fail, clamped", "z-fail"},
                            {"automatic / z-fail", "automatic", "z-fail"},
                            {"z-pass+ / z-pass", "z-pass+", "z-pass"}};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

class Timer {
 public:
  explicit Timer(const Options& options)
      : renderer_({options.device, false}), frames_(options.frames) {}

  Cost cost(const std::shared_ptr<const Scene>& scene, const Variant& variant,
            std::uint32_t width) {
    const auto resolved = techniques::resolve(variant.technique, variant.parameters);
    RenderRequest request;
    request.scene = scene;
    request.technique = resolved.technique;
    request.parameters = resolved.parameters;
    request.width = request.height = width;
    request.frames = frames_;
    return renderer_.render(request).cost;
  }

  const DeviceInfo& device() const { return renderer_.device(); }

 private:
  Renderer renderer_;
  std::uint32_t frames_;
};

/// Device time of the passes that make the shadows.
double shadow_ms(const Cost& cost) {
  double ms = 0.0;
  for (const PassCost& pass : cost.passes)
    if (pass.name == "volumes" || pass.name == "wedges") ms += pass.median_ms;
  return ms;
}

void print_ratios(const char* label, const std::vector<double>& values) {
  std::printf("| %s | %.2f (%.2f-%.2f) |", label, quantile(values, 0.5), quantile(values, 0.25),
              quantile(values, 0.75));
}

void measure_volumes(Timer& timer, const Options& options) {
  for (const char* id :
       {"boxes", "car", "camera-in-volume", "aircraft", "warehouse-outside", "sweep:100x800x1"}) {
    const auto scene = scenes::load(id);
    std::map<std::string, std::vector<double>> ms;
    std::map<std::string, PassCost> counts;
    for (int round = 0; round < options.rounds; ++round)
      for (const Variant& variant : variants()) {
        const Cost cost = timer.cost(scene, variant, options.width);
        ms[variant.label].push_back(shadow_ms(cost));
        for (const PassCost& pass : cost.passes)
          if (pass.name == "volumes") counts[variant.label] = pass;
      }
    std::printf("\n**%s**\n\n| variant | ms | polygons, thousands | fragments, thousands |\n", id);
    std::printf("|---|---|---|---|\n");
    for (const Variant& variant : variants()) {
      const PassCost& pass = counts[variant.label];
      std::printf("| %s | %.3f | %.1f | %.0f |\n", variant.label, quantile(ms[variant.label], 0.5),
                  1e-3 * static_cast<double>(pass.geometry_primitives),
                  1e-3 * static_cast<double>(pass.fragment_invocations));
    }
    std::printf("\n| ratio | median (quartiles) |\n|---|---|\n");
    for (const Ratio& ratio : ratios) {
      std::vector<double> values;
      for (std::size_t i = 0; i < ms[ratio.over].size(); ++i)
        values.push_back(ms[ratio.over][i] / ms[ratio.under][i]);
      print_ratios(ratio.label, values);
      std::printf("\n");
    }
    std::fflush(stdout);
  }
}

/// Occluder textures over a shadow map of 512 texels, whole frames (C11): pictures so small that
/// vertices count, and of full width, where samples do.
void measure_fleet(Timer& timer, const Options& options) {
  const Variant textures{"", "occluder-textures", {}};
  const Variant map{"", "shadow-map", {}};
  const Variant none{"", "none", {}};
  std::printf("\n**Occluder textures / shadow map, whole frames (C11)**\n\n");
  std::printf(
      "| aircraft, picture | ratio (quartiles) | shadows alone | vertices: textures, map |\n");
  std::printf("|---|---|---|---|\n");
  for (const int count : {1, 20, 50, 100, 200})
    for (const std::uint32_t width : {options.width / 8, options.width, 2 * options.width}) {
      const auto scene = std::make_shared<const Scene>(scenes::make_fleet(count));
      std::vector<double> whole, alone;
      double textures_vertices = 0.0, map_vertices = 0.0;
      for (int round = 0; round < options.rounds; ++round) {
        const Cost bare = timer.cost(scene, none, width);
        const Cost a = timer.cost(scene, textures, width);
        const Cost b = timer.cost(scene, map, width);
        whole.push_back(a.median_ms / b.median_ms);
        alone.push_back((a.median_ms - bare.median_ms) / (b.median_ms - bare.median_ms));
        textures_vertices = map_vertices = 0.0;
        for (const PassCost& pass : a.passes)
          textures_vertices += static_cast<double>(pass.vertices);
        for (const PassCost& pass : b.passes) map_vertices += static_cast<double>(pass.vertices);
      }
      const std::string label =
          std::to_string(count) + ", " + std::to_string(width) + "x" + std::to_string(width);
      print_ratios(label.c_str(), whole);
      std::printf(" %.2f | %.0f, %.0f |\n", quantile(alone, 0.5), textures_vertices, map_vertices);
      std::fflush(stdout);
    }
}

void run(const Options& options) {
  Timer timer(options);
  std::printf("%s (%s), %ux%u, %d rounds of the median of %u frames\n", timer.device().name.c_str(),
              timer.device().driver.c_str(), options.width, options.width, options.rounds,
              options.frames);
  if (options.part != "fleet") measure_volumes(timer, options);
  if (options.part != "volumes") measure_fleet(timer, options);
}

}  // namespace

int main(int count, char** values) {
  Options options;
  return penumbra::bench::run_program(
      count, values, "What shadows from geometry cost over each other",
      [&](CLI::App& app) {
        app.add_option("--part", options.part, "What to print")
            ->check(CLI::IsMember({"all", "volumes", "fleet"}));
        app.add_option("--width", options.width, "Pixels, width and height")
            ->check(CLI::PositiveNumber);
        app.add_option("--frames", options.frames, "Frames of a round, their median counts")
            ->check(CLI::PositiveNumber);
        app.add_option("--rounds", options.rounds, "Rounds over all variants")
            ->check(CLI::PositiveNumber);
        penumbra::bench::add_device_option(app, options.device);
      },
      [&] { run(options); });
}
