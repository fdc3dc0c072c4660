// What filters of maps cost over the width of their kernel, as Adorjan 2013, table 4.1:
// bench_maps_times [--part table|doubling|all] [--scene ID] [--frames N] [--pairs N] [--device X]
//
// 1024x768 pixels, a map of 1024x1024. First a table of device time per frame, then how much a
// savsm costs with a kernel twice as wide, over interleaved pairs.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "bench/program.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;

struct Options {
  std::string part = "all";
  std::string scene = "boxes";
  std::uint32_t frames = 9;
  int pairs = 15;
  std::string device;
};

/// A filter as a row of the table: the width of its kernel is set by `kernel`, or by `blur`, a
/// radius.
struct Filter {
  const char* label;
  const char* technique;
  bool blurred;
  ParameterValues parameters;
};

const std::vector<Filter>& filters() {
  const ParameterValue off = false, on = true;
  const ParameterValue box = std::string("box");
  static const std::vector<Filter> list{
      {"vsm", "vsm", true, {{"blur_filter", box}, {"mips", off}}},
      {"vsm, mips", "vsm", true, {{"blur_filter", box}}},
      {"esm-linear", "esm-linear", true, {{"blur_filter", box}, {"mips", off}}},
      {"esm-linear, mips", "esm-linear", true, {{"blur_filter", box}}},
      {"esm-log", "esm-log", true, {{"blur_filter", box}}},
      {"evsm", "evsm", true, {{"blur_filter", box}, {"mips", off}}},
      {"evsm, mips", "evsm", true, {{"blur_filter", box}}},
      {"msm", "msm", true, {{"blur_filter", box}, {"mips", off}}},
      {"msm-64", "msm-64", true, {{"blur_filter", box}, {"mips", off}}},
      {"pcf, bilinear", "pcf", false, {}},
      {"pcf, by the sampler", "pcf", false, {{"filter", std::string("hardware-bilinear")}}},
      {"pcf, adaptive", "pcf", false, {{"adaptive", on}}},
      {"savsm-int32", "savsm-int32", false, {{"adaptive", off}}},
      {"savsm-int32, adaptive", "savsm-int32", false, {}},
      {"savsm-fp32", "savsm-fp32", false, {{"adaptive", off}}},
      {"savsm-distributed", "savsm-distributed", false, {{"adaptive", off}}},
      {"savsm-fp64", "savsm-fp64", false, {{"adaptive", off}}}};
  return list;
}

class Timer {
 public:
  explicit Timer(const Options& options)
      : renderer_({options.device, false}),
        scene_(scenes::load(options.scene)),
        frames_(options.frames) {}

  /// Median device time of a frame, ms.
  double frame_ms(const Filter& filter, std::int64_t kernel) {
    ParameterValues parameters = filter.parameters;
    parameters["map_size"] = std::int64_t{1024};
    if (filter.blurred)
      parameters["blur"] = kernel / 2;
    else
      parameters["kernel"] = kernel;
    const auto resolved = techniques::resolve(filter.technique, parameters);
    RenderRequest request;
    request.scene = scene_;
    request.technique = resolved.technique;
    request.parameters = resolved.parameters;
    request.width = 1024;
    request.height = 768;
    request.frames = frames_;
    return renderer_.render(request).cost.median_ms;
  }

  const DeviceInfo& device() const { return renderer_.device(); }

 private:
  Renderer renderer_;
  std::shared_ptr<const Scene> scene_;
  std::uint32_t frames_;
};

void print_table(Timer& timer) {
  std::printf("| ms | 1x1 | 3x3 | 9x9 | 15x15 | 33x33 | 33 / 9 |\n|---|---|---|---|---|---|---|\n");
  for (const Filter& filter : filters()) {
    std::printf("| %s |", filter.label);
    double nine = 1.0, last = 0.0;
    for (const std::int64_t kernel : {1, 3, 9, 15, 33}) {
      last = timer.frame_ms(filter, kernel);
      if (kernel == 9) nine = last;
      std::printf(" %.3g |", last);
      std::fflush(stdout);
    }
    std::printf(" %.2f |\n", last / nine);
  }
}

/// Mean of the logarithms of paired ratios, and twice its standard error: about 95%.
void print_doubling(Timer& timer, int pairs) {
  const Filter filter{"", "savsm-int32", false, {{"adaptive", false}}};
  double sum = 0.0, squares = 0.0;
  timer.frame_ms(filter, 16);
  timer.frame_ms(filter, 32);
  for (int i = 0; i < pairs; ++i) {
    const double narrow = timer.frame_ms(filter, 16);
    const double ratio = std::log(timer.frame_ms(filter, 32) / narrow);
    sum += ratio;
    squares += ratio * ratio;
  }
  const double mean = sum / pairs;
  const double error = std::sqrt(std::max(squares / pairs - mean * mean, 0.0) / (pairs - 1));
  std::printf(
      "\nsavsm-int32, kernel 32 against 16, %d pairs: ratio %.3f, 95%% within %.3f and %.3f\n",
      pairs, std::exp(mean), std::exp(mean - 2.0 * error), std::exp(mean + 2.0 * error));
}

void run(const Options& options) {
  Timer timer(options);
  std::printf("Device: %s (%s). Scene %s, 1024x768, map 1024x1024, median of %u frames.\n\n",
              timer.device().name.c_str(), timer.device().driver.c_str(), options.scene.c_str(),
              options.frames);
  if (options.part != "doubling") print_table(timer);
  if (options.part != "table") print_doubling(timer, options.pairs);
}

}  // namespace

int main(int count, char** values) {
  Options options;
  return penumbra::bench::run_program(
      count, values, "Times of map filters over their kernel",
      [&](CLI::App& app) {
        app.add_option("--part", options.part, "What to print")
            ->check(CLI::IsMember({"all", "table", "doubling"}));
        app.add_option("--scene", options.scene, "A built-in scene");
        app.add_option("--frames", options.frames, "Frames that are timed")
            ->check(CLI::PositiveNumber);
        app.add_option("--pairs", options.pairs, "Interleaved pairs of frames, two at least")
            ->check(CLI::Range(2, 100000));
        penumbra::bench::add_device_option(app, options.device);
      },
      [&] { run(options); });
}
