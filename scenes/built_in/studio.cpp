#include "scenes/built_in/studio.h"

#include "scenes/generators/random.h"

namespace penumbra::scenes {

void add_studio(SceneBuilder& builder, const Look& look, double half_width, double back,
                double front, double bend_radius, double wall_height) {
  const double thickness = 0.2;
  const int steps = 16;
  // Side view: x runs to the rear, y upwards; the lower side of the sheet first.
  std::vector<glm::dvec2> polygon = {{-front, 0.0}, {-front, -thickness}, {back, -thickness}};
  const glm::dvec2 center(back, bend_radius);
  for (int i = 1; i < steps; ++i) {
    const glm::dvec2 c = circle(-90.0 + 90.0 * i / steps);
    polygon.push_back(center + (bend_radius + thickness) * c);
  }
  polygon.emplace_back(back + bend_radius + thickness, wall_height);
  polygon.emplace_back(back + bend_radius, wall_height);
  for (int i = steps; i >= 0; --i)
    polygon.push_back(center + bend_radius * circle(-90.0 + 90.0 * i / steps));
  builder.place(transformed(extrude(polygon, 2.0 * half_width), turn_y(90.0)), look, "studio",
                glm::dmat4(1.0), 20.0);
  builder.scene.receivers.push_back({"floor",
                                     {{-half_width, 0.0, -back},
                                      {-half_width, 0.0, front},
                                      {half_width, 0.0, front},
                                      {half_width, 0.0, -back}}});
}

}  // namespace penumbra::scenes
