// How near maps come to the reference on the six scenes of 2007, beside van Sambeek 2007,
// table 4.2: bench_maps_quality [--size N] [--light-samples N] [--device NAME]
//
// Two tables of every map technique and preset: rms_y of the picture, and the root mean square
// error of visibility. Pictures are 600x600 and maps 512x512 as there.
#include <cstdio>
#include <cstdlib>
#include <map>

#include "renderer/error.h"
#include "renderer/metrics/metrics.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;

const std::vector<std::string> scene_ids{
    "car", "boxes", "disco-box", "island", "warehouse-inside", "warehouse-outside"};

/// van Sambeek 2007, table 4.2, by the preset whose settings are his.
const std::map<std::string, std::vector<double>> published{
    {"shadow-map", {7.739, 7.790, 4.371, 13.728, 4.282, 8.342}},
    {"pcf-3x3", {7.370, 6.327, 3.610, 14.711, 3.933, 8.145}},
    {"pcf-bilinear", {7.517, 7.078, 3.658, 12.169, 4.118, 8.246}},
    {"pcf-bilinear-3x3", {7.303, 6.132, 3.477, 14.507, 3.884, 8.125}},
    {"pcss-nearest", {5.400, 6.982, 3.797, 21.356, 1.862, 8.195}},
    {"vsm-2007", {7.370, 8.433, 4.667, 17.481, 4.007, 7.644}}};

struct Options {
  std::uint32_t size = 600;
  std::uint32_t light_samples = 256;
  std::string device;
};

Options read_options(int count, char** values) {
  Options options;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string name = values[i];
    if (name == "--size")
      options.size = static_cast<std::uint32_t>(std::atoi(values[i + 1]));
    else if (name == "--light-samples")
      options.light_samples = static_cast<std::uint32_t>(std::atoi(values[i + 1]));
    else if (name == "--device")
      options.device = values[i + 1];
    else
      throw bad_value(name, "bench_maps_quality takes --size, --light-samples and --device");
  }
  return options;
}

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
  for (const std::string& scene : scene_ids) std::printf(" %s |", scene.c_str());
  std::printf(" mean |\n|---|---|---|---|---|---|---|---|\n");
}

void run(const Options& options) {
  Renderer renderer({options.device, false});
  std::map<std::string, Row> pictures, visibilities;
  for (const std::string& id : scene_ids) {
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
    if (published.contains(name)) print_row("(" + name + ")", published.at(name), 2);
  }
  std::printf("\nrms of visibility, 0..1:\n\n");
  print_head();
  for (const std::string& name : subjects()) print_row(name, visibilities.at(name), 4);
}

}  // namespace

int main(int count, char** values) {
  try {
    run(read_options(count, values));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_maps_quality: %s\n", error.what());
    return 1;
  }
}
