// Exposure that a request asks for.
#include <gtest/gtest.h>

#include "renderer/error.h"
#include "tests/volumes/drawing.h"

namespace penumbra {
namespace {

RenderResult exposed(std::optional<double> exposure, float of_scene) {
  scenes::SceneBuilder b("plain", "A ground");
  b.ground({-3.0, -3.0}, {3.0, 3.0}, b.look("grey", glm::vec3(0.5f)));
  b.spot("lamp", {0.0, 3.0, 0.0}, {0.0, 0.0, 0.1}, glm::vec3(1.0f), 1.0f, 60.0, LightExtent{});
  b.camera("main", {0.0, 2.0, 2.0}, {0.0, 0.0, 0.0}, 40.0);
  b.scene.exposure = of_scene;
  const auto resolved = techniques::resolve("none", {});
  RenderRequest request;
  request.scene = std::make_shared<const Scene>(b.scene);
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.width = request.height = 16;
  request.linear = true;
  request.exposure = exposure;
  return test::renderer().render(request);
}

TEST(Exposure, multiplies_linear_light_by_a_power_of_two_in_place_of_the_scenes_factor) {
  const ImageF own = exposed({}, 0.5f).linear;
  for (const double exposure : {-3.0, -1.0, 0.0, 1.5, 4.0}) {
    const ImageF other = exposed(exposure, 0.5f).linear;
    for (std::size_t pixel = 0; pixel < own.pixel_count(); ++pixel)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t i = pixel * own.channels + c;
        ASSERT_NEAR(other.pixels[i] / own.pixels[i], std::exp2(exposure) / 0.5,
                    1e-3 * std::exp2(exposure));
      }
  }
}

TEST(Exposure, out_of_range_is_an_error_of_its_field) {
  for (const double exposure : {-31.0, 31.0, std::nan("")}) {
    try {
      exposed(exposure, 1.0f);
      ADD_FAILURE() << exposure << " was drawn";
    } catch (const Error& error) {
      EXPECT_EQ(error.field, "exposure");
    }
  }
}

}  // namespace
}  // namespace penumbra
