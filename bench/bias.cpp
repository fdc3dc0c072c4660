// How bias trades acne for detached shadows:
//   bench_bias [--part best|sweep|depth] [--size N] [--scenes a,b] [--filters a,b] [--maps N,N]
//              [--device NAME]
//
// Errors are the root mean square of visibility, and the shares of pixels that are falsely shadowed
// (acne) and falsely lit (detached shadows, leaks), over the strategies and the two numbers that a
// user may turn: bias in metres, as a share of the scene's size, and slope_scale. The truth is the
// exact hard shadow, for pcss the soft one.
//
// best prints what tuning by hand gains over strategy auto, for every scene, filter and size of the
// map; sweep prints every setting of slope_scale 1; depth what even and hyperbolic depth in 32 and
// 16 bits cost, over a fitted range and over one that a person might fix for any scene, each with
// the bias that it asks for.
#include <cstdio>
#include <cstdlib>
#include <map>

#include "bench/program.h"
#include "renderer/error.h"
#include "renderer/metrics/metrics.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;

struct Options {
  std::string part = "best";
  std::uint32_t size = 200;
  std::vector<std::string> scenes{
      "car", "boxes", "disco-box", "island", "warehouse-inside", "warehouse-outside"};
  std::vector<std::string> filters{"hard", "pcf-3", "pcf-9", "pcss"};
  std::vector<std::int64_t> maps{256, 512, 1024};
  std::string device;
};

struct Filter {
  std::string technique;
  ParameterValues parameters;
};

/// hard, pcf-3, pcf-9, or the id of a map technique or preset.
Filter filter_of(const std::string& name) {
  if (name == "hard") return {"shadow-map", {}};
  if (name == "pcf-3") return {"pcf", {{"kernel", std::int64_t{3}}}};
  if (name == "pcf-9") return {"pcf", {{"kernel", std::int64_t{9}}}};
  return {name, {}};
}

struct Setting {
  std::string strategy;
  double bias = 0.0;  ///< m
  double slope_scale = 1.0;
};

/// One scene, its truths, and errors of settings against them.
class Subject {
 public:
  Subject(Renderer& renderer, const std::string& id, std::uint32_t size)
      : renderer_(renderer), scene_(scenes::load(id)), size_(size) {
    hard_truth_ = render("ray-traced", {}, 1).visibility;
  }

  metrics::VisibilityError error(Filter filter, std::int64_t map_size, const Setting& setting) {
    filter.parameters["bias_strategy"] = setting.strategy;
    filter.parameters["bias"] = setting.bias;
    filter.parameters["slope_scale"] = setting.slope_scale;
    return error(filter, map_size);
  }

  metrics::VisibilityError error(const Filter& filter, std::int64_t map_size) {
    ParameterValues parameters = filter.parameters;
    parameters["map_size"] = map_size;
    const RenderResult result = render(filter.technique, parameters, 1);
    return metrics::visibility_error(result.visibility, truth_of(filter), result.judged);
  }

  /// Diagonal of the scene's box, m.
  double extent() const {
    const Bounds bounds = world_bounds(*scene_);
    return glm::length(bounds.size());
  }

 private:
  const ImageF& truth_of(const Filter& filter) {
    if (filter.technique != "pcss") return hard_truth_;
    if (soft_truth_.pixels.empty()) soft_truth_ = render("reference", {}, 256).visibility;
    return soft_truth_;
  }

  RenderResult render(const std::string& technique, const ParameterValues& parameters,
                      std::uint32_t light_samples) {
    const auto resolved = techniques::resolve(technique, parameters);
    RenderRequest request;
    request.scene = scene_;
    request.technique = resolved.technique;
    request.parameters = resolved.parameters;
    request.width = request.height = size_;
    request.light_samples = light_samples;
    request.visibility = true;
    return renderer_.render(request);
  }

  Renderer& renderer_;
  std::shared_ptr<const Scene> scene_;
  std::uint32_t size_;
  ImageF hard_truth_;
  ImageF soft_truth_;
};

double sum_of(const metrics::VisibilityError& error) {
  return error.false_shadow + error.missing_shadow;
}

/// Everything that a person may try.
std::vector<Setting> settings_by_hand(double extent) {
  std::vector<Setting> list;
  for (const char* strategy : {"constant", "slope", "normal-offset", "receiver-plane", "back-faces",
                               "second-depth", "midpoint", "dual-depth"})
    for (const double slope_scale : {0.0, 1.0, 2.0})
      for (const double share : {0.0, 1e-4, 3e-4, 1e-3, 3e-3})
        list.push_back({strategy, share * extent, slope_scale});
  return list;
}

void print_sweep(Subject& subject, const std::string& scene, const std::string& filter,
                 std::int64_t map_size) {
  for (const Setting& setting : settings_by_hand(subject.extent())) {
    if (setting.slope_scale != 1.0) continue;
    const auto error = subject.error(filter_of(filter), map_size, setting);
    std::printf("| %s | %s | %lld | %s | %.4g | %.4f | %.4f | %.4f |\n", scene.c_str(),
                filter.c_str(), static_cast<long long>(map_size), setting.strategy.c_str(),
                setting.bias, error.false_shadow, error.missing_shadow, sum_of(error));
  }
}

/// The setting by hand with the least of one measure.
struct Best {
  double value = 1e9;
  Setting setting;

  void offer(double offered, const Setting& by) {
    if (offered < value) *this = {offered, by};
  }
  std::string text() const {
    char line[96];
    std::snprintf(line, sizeof line, "%.4f (%s, %.3g, %g)", value, setting.strategy.c_str(),
                  setting.bias, setting.slope_scale);
    return line;
  }
};

void print_best(Subject& subject, const std::string& scene, const std::string& filter,
                std::int64_t map_size) {
  Best least_rms, least_sum;
  const auto error = [&](const Setting& setting) {
    return subject.error(filter_of(filter), map_size, setting);
  };
  for (const Setting& setting : settings_by_hand(subject.extent())) {
    const auto errors = error(setting);
    least_rms.offer(errors.rms, setting);
    least_sum.offer(sum_of(errors), setting);
  }
  const auto untouched = error({"auto"});
  const auto plane = error({"receiver-plane"});
  std::printf("| %s | %s | %lld | %.4f | %.4f | %s | %.2f | %.2f | %.4f | %.4f | %s | %.2f |\n",
              scene.c_str(), filter.c_str(), static_cast<long long>(map_size), untouched.rms,
              plane.rms, least_rms.text().c_str(), untouched.rms / least_rms.value,
              plane.rms / least_rms.value, untouched.false_shadow, untouched.missing_shadow,
              least_sum.text().c_str(), sum_of(untouched) / least_sum.value);
}

void print_depths(Subject& subject, const std::string& scene, const std::string& filter,
                  std::int64_t map_size) {
  const double near = 1e-4 * subject.extent(), far = 4.0 * subject.extent();
  for (const bool fitted : {true, false})
    for (const char* bits : {"32", "16"})
      for (const char* depth : {"linear", "hyperbolic"}) {
        Filter coded = filter_of(filter);
        coded.parameters["depth"] = std::string(depth);
        coded.parameters["depth_bits"] = std::string(bits);
        coded.parameters["near"] = fitted ? 0.0 : near;
        coded.parameters["far"] = fitted ? 0.0 : far;
        const auto error = subject.error(coded, map_size);
        char range[64] = "fitted";
        if (!fitted) std::snprintf(range, sizeof range, "%.3g to %.3g m", near, far);
        std::printf("| %s | %s | %lld | %s | %s | %s | %.4f | %.4f | %.4f |\n", scene.c_str(),
                    filter.c_str(), static_cast<long long>(map_size), range, bits, depth,
                    error.false_shadow, error.missing_shadow, sum_of(error));
      }
}

/// How each part begins its table, and prints what one scene, filter and size add to it.
struct Part {
  const char* head;
  void (*print)(Subject&, const std::string& scene, const std::string& filter,
                std::int64_t map_size);
};

const std::map<std::string, Part>& parts() {
  static const std::map<std::string, Part> list{
      {"best",
       {"| scene | filter | map | auto: rms | plane: rms | best rms (by) | auto / best | plane / "
        "best "
        "| auto: false | missing | best sum (by) | auto / best |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        print_best}},
      {"sweep",
       {"| scene | filter | map | strategy | bias, m | false shadow | missing shadow | sum |\n"
        "|---|---|---|---|---|---|---|---|\n",
        print_sweep}},
      {"depth",
       {"| scene | filter | map | range | bits | depth | false shadow | missing shadow | sum |\n"
        "|---|---|---|---|---|---|---|---|---|\n",
        print_depths}}};
  return list;
}

void run(const Options& options) {
  if (!parts().contains(options.part))
    throw bad_value("--part", "there are best, sweep and depth, not " + options.part);
  const Part& part = parts().at(options.part);
  Renderer renderer({options.device, false});
  std::printf("Device: %s (%s). Pictures %ux%u.\n\n", renderer.device().name.c_str(),
              renderer.device().driver.c_str(), options.size, options.size);
  std::printf("%s", part.head);
  for (const std::string& scene : options.scenes) {
    Subject subject(renderer, scene, options.size);
    for (const std::string& filter : options.filters)
      for (const std::int64_t map_size : options.maps) {
        part.print(subject, scene, filter, map_size);
        std::fflush(stdout);
      }
  }
}

}  // namespace

int main(int count, char** values) {
  Options options;
  return penumbra::bench::run_program(
      count, values, "Errors over bias",
      [&](CLI::App& app) {
        app.add_option("--part", options.part, "What to print")
            ->check(CLI::IsMember({"best", "sweep", "depth"}));
        penumbra::bench::add_size_option(app, options.size);
        app.add_option("--scenes", options.scenes, "Built-in scenes")->delimiter(',');
        app.add_option("--filters", options.filters, "hard, pcf-3, pcf-9, or techniques")
            ->delimiter(',');
        app.add_option("--maps", options.maps, "Sizes of maps, texels")->delimiter(',');
        penumbra::bench::add_device_option(app, options.device);
      },
      [&] { run(options); });
}
