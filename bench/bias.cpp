// How bias trades acne for detached shadows: bench_bias [--size N] [--scenes a,b] [--device NAME]
//
// For every scene and strategy, the share of pixels that are falsely shadowed (acne) and falsely
// lit (detached shadows, leaks), against the exact hard shadow, over the two numbers a user may
// turn: bias in metres, as a share of the scene's size, and slope_scale.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "renderer/error.h"
#include "renderer/metrics/metrics.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;

struct Options {
  std::uint32_t size = 300;
  std::string scenes = "car,boxes,disco-box,island,warehouse-inside,warehouse-outside";
  std::string device;
};

Options read_options(int count, char** values) {
  Options options;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string name = values[i];
    if (name == "--size")
      options.size = static_cast<std::uint32_t>(std::atoi(values[i + 1]));
    else if (name == "--scenes")
      options.scenes = values[i + 1];
    else if (name == "--device")
      options.device = values[i + 1];
    else
      throw bad_value(name, "bench_bias takes --size, --scenes and --device");
  }
  return options;
}

/// One scene, its truth, and errors of settings against it.
class Subject {
 public:
  Subject(Renderer& renderer, const std::string& id, std::uint32_t size)
      : renderer_(renderer), scene_(scenes::load(id)), size_(size) {
    truth_ = render("ray-traced", {}).visibility;
  }

  metrics::VisibilityError error(const std::string& strategy, double bias, double slope_scale) {
    const RenderResult result = render(
        "shadow-map", {{"bias_strategy", strategy}, {"bias", bias}, {"slope_scale", slope_scale}});
    return metrics::visibility_error(result.visibility, truth_, result.judged);
  }

  /// Diagonal of the scene's box, m.
  double extent() const {
    const Bounds bounds = world_bounds(*scene_);
    return glm::length(bounds.size());
  }

 private:
  RenderResult render(const std::string& technique, const ParameterValues& parameters) {
    const auto resolved = techniques::resolve(technique, parameters);
    RenderRequest request;
    request.scene = scene_;
    request.technique = resolved.technique;
    request.parameters = resolved.parameters;
    request.width = request.height = size_;
    request.light_samples = 1;
    request.visibility = true;
    return renderer_.render(request);
  }

  Renderer& renderer_;
  std::shared_ptr<const Scene> scene_;
  std::uint32_t size_;
  ImageF truth_;
};

struct Best {
  double error = 1e9;
  std::string settings;
};

/// A row for each setting of one strategy; keeps the best.
void sweep(Subject& subject, const std::string& scene, const std::string& strategy, Best& best) {
  for (const double slope_scale : {0.0, 0.5, 1.0, 2.0}) {
    for (const double share : {0.0, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3}) {
      const double bias = share * subject.extent();
      const auto error = subject.error(strategy, bias, slope_scale);
      const double both = error.false_shadow + error.missing_shadow;
      if (slope_scale == 1.0)
        std::printf("| %s | %s | %.4g | %.4f | %.4f | %.4f |\n", scene.c_str(), strategy.c_str(),
                    bias, error.false_shadow, error.missing_shadow, both);
      char settings[96];
      std::snprintf(settings, sizeof settings, "%s, bias %.3g, slope_scale %g", strategy.c_str(),
                    bias, slope_scale);
      if (both < best.error) best = {both, settings};
    }
  }
}

void run(const Options& options) {
  Renderer renderer({options.device, false});
  std::printf("Device: %s (%s). Pictures %ux%u, maps 512x512, one ray a pixel as the truth.\n\n",
              renderer.device().name.c_str(), renderer.device().driver.c_str(), options.size,
              options.size);
  std::printf("| scene | strategy | bias, m | false shadow | missing shadow | sum |\n");
  std::printf("|---|---|---|---|---|---|\n");
  std::ostringstream summary;
  std::istringstream list(options.scenes);
  for (std::string scene; std::getline(list, scene, ',');) {
    Subject subject(renderer, scene, options.size);
    Best best;
    for (const char* strategy : {"constant", "slope", "normal-offset", "receiver-plane",
                                 "back-faces", "second-depth", "midpoint", "dual-depth"})
      sweep(subject, scene, strategy, best);
    const auto untouched = subject.error("auto", 0.0, 1.0);
    const auto plane = subject.error("receiver-plane", 0.0, 1.0);
    const double both = untouched.false_shadow + untouched.missing_shadow;
    char row[256];
    std::snprintf(row, sizeof row, "| %s | %.4f | %.4f | %.4f | %.4f | %.4f | %s | %.2f |\n",
                  scene.c_str(), untouched.false_shadow, untouched.missing_shadow, both,
                  plane.false_shadow + plane.missing_shadow, best.error, best.settings.c_str(),
                  both / best.error);
    summary << row;
    std::fflush(stdout);
  }
  std::printf(
      "\n| scene | auto: false | missing | sum | receiver-plane: sum | best by hand: sum | its "
      "settings | auto / best |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n%s", summary.str().c_str());
}

}  // namespace

int main(int count, char** values) {
  try {
    run(read_options(count, values));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_bias: %s\n", error.what());
    return 1;
  }
}
