// Workers draw for days: a frame that was drawn before takes no memory.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <limits>

#include "renderer/render.h"
#include "techniques/registry.h"
#include "tests/conformance/scenes.h"

namespace penumbra {
namespace {

/// Of all of the process's heaps.
double bytes_in_use() {
  const auto heaps = mallinfo2();
  return static_cast<double>(heaps.uordblks + heaps.hblkhd);
}

/// What a further frame takes, in bytes, once everything has been drawn that is drawn at all: the
/// least of three tries, for drivers have threads that free later.
double growth(Renderer& renderer, RenderRequest request) {
  constexpr std::uint32_t frames = 16;
  request.width = 48;
  request.height = 36;
  request.light_samples = 64;
  request.frames = frames;
  renderer.render(request);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double before = bytes_in_use();
    renderer.render(request);
    least = std::min(least, (bytes_in_use() - before) / frames);
  }
  return least;
}

constexpr double most_growth = 16.0 * 1024.0;

RenderRequest request_for(Scene scene, const std::string& technique,
                          const ParameterValues& parameters = {}) {
  RenderRequest request;
  request.scene = std::make_shared<const Scene>(std::move(scene));
  const auto resolved = techniques::resolve(technique, parameters);
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  return request;
}

std::vector<std::string> choices_of(const techniques::Resolved& technique,
                                    const std::string& parameter) {
  for (const Parameter& each : technique.technique->parameters)
    if (each.name == parameter) return each.choices;
  return {};
}

// Mesa 22.3 compiles a program anew for every draw, and keeps each, where constants alone decide a
// branch (decision 67): some techniques took megabytes a frame.
TEST(Growth, IsNoneFromFrameToFrame) {
  Renderer renderer({"", false});
  for (const TechniqueDescription& technique : techniques::all())
    for (const ExtentKind extent : {ExtentKind::disc, ExtentKind::rectangle}) {
      Scene scene = test::box_on_ground();
      for (Light& light : scene.lights) {
        light.extent.kind = extent;
        light.extent.radius = 0.1;
        light.extent.size = {0.2, 0.2};
      }
      EXPECT_LT(growth(renderer, request_for(std::move(scene), technique.id)), most_growth)
          << technique.id;
    }
}

TEST(Growth, IsNoneWhateverAMapIsMadeOf) {
  Renderer renderer({"", false});
  std::size_t tried = 0;
  for (const std::string name : {"layout", "depth", "bias_strategy"})
    for (const std::string& choice : choices_of(techniques::resolve("shadow-map", {}), name)) {
      Scene scene = test::box_on_ground();
      // Cascades are for directional lights, and depths of parallel rays all alike.
      if (name == "layout")
        for (Light& light : scene.lights) light.kind = LightKind::directional;
      const double bytes =
          growth(renderer, request_for(std::move(scene), "shadow-map", {{name, choice}}));
      EXPECT_LT(bytes, most_growth) << name << " " << choice;
      ++tried;
    }
  EXPECT_GT(tried, 12u);
}

}  // namespace
}  // namespace penumbra
