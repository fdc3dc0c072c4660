#include "experiments/sweep/grid.h"

#include <fnmatch.h>

#include <algorithm>
#include <cstdio>

#include "renderer/error.h"
#include "scenes/library.h"

namespace penumbra::experiments {

std::vector<std::uint32_t> swept_sizes() {
  std::vector<std::uint32_t> sizes{25, 50};
  for (std::uint32_t size = 100; size <= 1200; size += 100) sizes.push_back(size);
  return sizes;
}

std::optional<SweepScene> read_sweep_scene(const std::string& name) {
  SweepScene scene;
  int end = 0;
  if (std::sscanf(name.c_str(), "sweep:%dx%dx%d%n", &scene.objects, &scene.triangles, &scene.lights,
                  &end) != 3 ||
      static_cast<std::size_t>(end) != name.size())
    return std::nullopt;
  return scene;
}

std::string sweep_scene(const SweepScene& scene) {
  return "sweep:" + std::to_string(scene.objects) + "x" + std::to_string(scene.triangles) + "x" +
         std::to_string(scene.lights);
}

std::vector<std::string> matching_scenes(const std::vector<std::string>& patterns) {
  std::vector<std::string> names;
  for (const int triangles : swept_triangles)
    for (int lights = 1; lights <= swept_lights; ++lights)
      for (const int objects : swept_objects)
        names.push_back(sweep_scene({objects, triangles, lights}));
  for (const auto& scene : scenes::built_in()) names.push_back(scene.id);
  std::vector<std::string> found;
  const auto add = [&](const std::string& name) {
    if (std::find(found.begin(), found.end(), name) == found.end()) found.push_back(name);
  };
  for (const std::string& pattern : patterns) {
    if (pattern.find_first_of("*?[") == std::string::npos) {
      add(pattern);
      continue;
    }
    bool any = false;
    for (const std::string& name : names)
      if (::fnmatch(pattern.c_str(), name.c_str(), 0) == 0) {
        add(name);
        any = true;
      }
    if (!any)
      throw not_found("scenes", "no scene is named like '" + pattern +
                                    "': sweep:OxTxL with O of 1, 5, 10, 25, 50, 100, 200, T of "
                                    "100, 1600, 10000 and L of 1 to 3, and built-in ids");
  }
  return found;
}

const std::vector<PublishedLimit>& table_4_1() {
  static const std::vector<PublishedLimit> rows{
      {"No", "none", "shaders", {}},
      {"SSM", "shadow-map", "shaders", {std::nullopt, 140.0}},
      {"PCF", "pcf-hardware-bilinear:kernel=3:bias_strategy=constant", "shaders", {135.0, 82.0}},
      // "1 at 600x600": none at 1200 x 1200.
      {"PCSS", "pcss-nearest", "shaders", {0.0, 0.0}},
      {"VSM", "vsm-2007", "shaders", {150.0, 80.0}},
      {"SV", "shadow-volumes-zpass", "fill rate", {75.0, 8.0}},
      {"SSV", "soft-shadow-volumes-2007", "fill rate", {25.0, 4.0}}};
  return rows;
}

}  // namespace penumbra::experiments
