// Every technique on the survey's scenes: bench_techniques [--width N] [--light-samples N]
// [--frames N] [--device NAME]. Prints milliseconds of device time per frame (median) and rms_y
// against the reference that the same device drew, so that two devices can be laid side by side.
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "bench/program.h"
#include "renderer/error.h"
#include "renderer/metrics/metrics.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;

constexpr const char* scene_ids[] = {
    "car", "boxes", "disco-box", "island", "warehouse-inside", "warehouse-outside"};

struct Options {
  std::uint32_t width = 300;
  std::uint32_t light_samples = 256;
  std::uint32_t frames = 5;
  std::string device;
};

struct Cell {
  std::string ms = "-";
  std::string rms_y = "-";
};

std::string text(const char* format, double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

void print_table(const char* title, const std::vector<std::string>& rows,
                 const std::map<std::string, std::map<std::string, Cell>>& cells,
                 std::string Cell::*value) {
  std::printf("\n%s\n\n| technique |", title);
  for (const char* scene : scene_ids) std::printf(" %s |", scene);
  std::printf("\n|---|---|---|---|---|---|---|\n");
  for (const std::string& row : rows) {
    std::printf("| `%s` |", row.c_str());
    for (const char* scene : scene_ids)
      std::printf(" %s |", (cells.at(row).at(scene).*value).c_str());
    std::printf("\n");
  }
}

void run(const Options& options) {
  std::vector<std::string> rows;
  for (const auto& technique : techniques::all()) rows.push_back(technique.id);
  for (const auto& preset : techniques::presets()) rows.push_back(preset.id);
  Renderer renderer({.device = options.device});
  std::map<std::string, std::map<std::string, Cell>> cells;
  for (const char* id : scene_ids) {
    RenderRequest request;
    request.scene = scenes::load(id);
    request.width = request.height = options.width;
    request.light_samples = options.light_samples;
    request.technique = techniques::resolve("reference").technique;
    const Image8 truth = renderer.render(request).picture;
    for (const std::string& row : rows) {
      const auto resolved = techniques::resolve(row);
      request.technique = resolved.technique;
      request.parameters = resolved.parameters;
      request.frames = options.frames;
      Cell& cell = cells[row][id];
      try {
        const RenderResult result = renderer.render(request);
        cell.ms = text("%.2f", result.cost.median_ms);
        cell.rms_y = text("%.2f", metrics::rms_y(result.picture, truth));
        if (result.non_finite_pixels > 0) cell.rms_y += " (not finite)";
      } catch (const Error& error) {
        if (error.code != "unsupported") throw;
        std::fprintf(stderr, "%s, %s: %s\n", id, row.c_str(), error.what());
      }
    }
    request.parameters = {};
    request.frames = 1;
    std::fprintf(stderr, "%s\n", id);
  }
  const DeviceInfo& device = renderer.device();
  std::printf("%s (%s), %ux%u, %u light samples, median of %u frames\n", device.name.c_str(),
              device.driver.c_str(), options.width, options.width, options.light_samples,
              options.frames);
  print_table("Milliseconds per frame", rows, cells, &Cell::ms);
  print_table("rms_y against the reference, 0..255", rows, cells, &Cell::rms_y);
}

}  // namespace

int main(int count, char** values) {
  Options options;
  return penumbra::bench::run_program(
      count, values, "Times and errors of every technique on the scenes of the survey",
      [&](CLI::App& app) {
        app.add_option("--width", options.width, "Pixels, width and height")
            ->check(CLI::PositiveNumber);
        app.add_option("--light-samples", options.light_samples, "Of the reference")
            ->check(CLI::PositiveNumber);
        app.add_option("--frames", options.frames, "Frames that are timed")
            ->check(CLI::PositiveNumber);
        penumbra::bench::add_device_option(app, options.device);
      },
      [&] { run(options); });
}
