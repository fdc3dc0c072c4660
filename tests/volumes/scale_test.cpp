// One scene at many sizes: every technique draws the same shadows.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/volumes/drawing.h"

namespace penumbra {
namespace scale_test {

using test::draw;
constexpr std::uint32_t width = 48;

/// A box over the ground, all lengths multiplied.
Scene scaled(double s) {
  scenes::SceneBuilder b("scaled", "A box over the ground");
  const scenes::Look grey = b.look("grey", glm::vec3(0.7f));
  b.ground({-3.0 * s, -3.0 * s}, {3.0 * s, 3.0 * s}, grey, "ground", 0.2 * s);
  b.place(scenes::box(s * glm::dvec3(-0.5, 0.0, -0.2), s * glm::dvec3(0.5, 1.0, 0.2)), grey, "box");
  b.spot("lamp", s * glm::dvec3(-2.0, 4.0, 2.5), {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 40.0,
         scenes::disc(0.2 * s));
  b.camera("main", s * glm::dvec3(2.5, 3.0, 4.0), s * glm::dvec3(0.0, 0.3, 0.0), 40.0);
  b.scene.cameras[0].near_plane = 0.05 * s;
  return b.scene;
}

TEST(Scale, changes_the_picture_of_no_technique) {
  for (const auto& technique : techniques::all()) {
    if (technique.family == "truth") continue;
    const RenderResult metre = draw(scaled(1.0), technique.id, {}, {}, width);
    for (const double s : {1e-4, 1e-2, 1e2, 1e5}) {
      const RenderResult other = draw(scaled(s), technique.id, {}, {}, width);
      double sum = 0.0;
      for (std::size_t i = 0; i < metre.visibility.pixels.size(); ++i)
        sum += std::abs(static_cast<double>(metre.visibility.pixels[i]) -
                        static_cast<double>(other.visibility.pixels[i]));
      EXPECT_LT(sum / static_cast<double>(metre.visibility.pixels.size()), 0.003)
          << technique.id << " at " << s;
    }
  }
}

}  // namespace scale_test
}  // namespace penumbra
