// How near maps come to the reference on the six scenes of 2007, beside van Sambeek 2007,
// table 4.2: bench_maps_quality [--size N] [--light-samples N] [--device NAME]
//
// Two tables of every map technique and preset: rms_y of the picture, and the root mean square
// error of visibility. Pictures are 600x600 and maps 512x512 as there. Last, how far the sampler's
// bilinear comparison lies from the shader's.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "bench/program.h"
#include "renderer/metrics/metrics.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "study/van_sambeek_2007.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;

struct Options {
  std::uint32_t size = 600;
  std::uint32_t light_samples = 256;
  std::string device;
};

/// Every map technique by its own id and by its presets'.
std::vector<std::string> subjects() {
  std::vector<std::string> list;
  for (const TechniqueDescription& technique : techniques::all()) {
    if (technique.family != "map") continue;
    list.push_back(technique.id);
    for (const techniques::Preset& preset : techniques::presets())
      if (preset.technique == technique.id) list.push_back(preset.id);
  }
  return list;
}

using Row = std::vector<double>;

void print_row(const std::string& name, const Row& row, int digits) {
  std::printf("| %s |", name.c_str());
  double sum = 0.0;
  for (const double value : row) {
    std::printf(" %.*f |", digits, value);
    sum += value;
  }
  std::printf(" %.*f |\n", digits, sum / static_cast<double>(row.size()));
}

void print_head() {
  std::printf("| technique |");
  for (const std::string& scene : published::scenes) std::printf(" %s |", scene.c_str());
  std::printf(" mean |\n|---|---|---|---|---|---|---|---|\n");
}

/// Greatest difference of visibility between the comparison that the sampler interpolates and the
/// one that the shader does, each with one depth for all four texels; in units of 1/255.
double sampler_difference(Renderer& renderer, const std::shared_ptr<const Scene>& scene,
                          std::uint32_t size) {
  const auto draw = [&](const char* preset) {
    const auto resolved = techniques::resolve(preset, {{"bias_strategy", std::string("constant")}});
    RenderRequest request;
    request.scene = scene;
    request.technique = resolved.technique;
    request.parameters = resolved.parameters;
    request.width = request.height = size;
    request.visibility = true;
    return renderer.render(request).visibility.pixels;
  };
  const std::vector<float> sampled = draw("pcf-hardware-bilinear"), shaded = draw("pcf-bilinear");
  float worst = 0.0f;
  for (std::size_t i = 0; i < shaded.size(); ++i)
    worst = std::max(worst, std::abs(sampled[i] - shaded[i]));
  return 255.0 * static_cast<double>(worst);
}

void run(const Options& options) {
  Renderer renderer({options.device, false});
  std::map<std::string, Row> pictures, visibilities;
  Row differences;
  for (const std::string& id : published::scenes) {
    const auto scene = scenes::load(id);
    const auto render = [&](const std::string& name) {
      const auto resolved = techniques::resolve(name);
      RenderRequest request;
      request.scene = scene;
      request.technique = resolved.technique;
      request.parameters = resolved.parameters;
      request.width = request.height = options.size;
      request.light_samples = options.light_samples;
      request.visibility = true;
      return renderer.render(request);
    };
    differences.push_back(sampler_difference(renderer, scene, options.size));
    const RenderResult truth = render("reference");
    for (const std::string& name : subjects()) {
      const RenderResult result = render(name);
      pictures[name].push_back(metrics::rms_y(result.picture, truth.picture));
      visibilities[name].push_back(
          metrics::visibility_error(result.visibility, truth.visibility, result.judged).rms);
    }
    std::fprintf(stderr, "%s done\n", id.c_str());
  }
  std::printf("Device: %s (%s). %ux%u, reference of %u light samples.\n\n",
              renderer.device().name.c_str(), renderer.device().driver.c_str(), options.size,
              options.size, options.light_samples);
  std::printf("rms_y, 0..255; rows in brackets are van Sambeek's of 2007:\n\n");
  print_head();
  for (const std::string& name : subjects()) {
    print_row(name, pictures.at(name), 2);
    if (published::rms_y.contains(name)) print_row("(" + name + ")", published::rms_y.at(name), 2);
  }
  std::printf("\nrms of visibility, 0..1:\n\n");
  print_head();
  for (const std::string& name : subjects()) print_row(name, visibilities.at(name), 4);
  std::printf("\npcf-hardware-bilinear against pcf-bilinear, bias_strategy constant, in 1/255:");
  for (std::size_t i = 0; i < differences.size(); ++i)
    std::printf("%s %s %.2f", i == 0 ? "" : ",", published::scenes[i].c_str(), differences[i]);
  const double worst = *std::max_element(differences.begin(), differences.end());
  std::printf("; the greatest is %.2f: %s\n", worst, worst <= 1.0 ? "alike" : "not alike");
}

}  // namespace

int main(int count, char** values) {
  Options options;
  return penumbra::bench::run_program(
      count, values, "Errors of every map technique beside table 4.2 of van Sambeek 2007",
      [&](CLI::App& app) {
        penumbra::bench::add_size_option(app, options.size);
        app.add_option("--light-samples", options.light_samples, "Of the reference")
            ->check(CLI::PositiveNumber);
        penumbra::bench::add_device_option(app, options.device);
      },
      [&] { run(options); });
}
