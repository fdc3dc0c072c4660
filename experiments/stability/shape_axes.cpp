// Axes of scale, place and shape.
#include "experiments/stability/axes.h"
#include "experiments/stability/subjects.h"

namespace penumbra::experiments::stability {
namespace {

/// A trial of the subject scene with one thing changed.
Axis shape_axis(const std::string& id, const std::string& title, const std::string& unit,
                std::vector<double> values, double SubjectShape::*what) {
  return {id, title, unit, std::move(values), [what](double value) {
            SubjectShape shape;
            shape.*what = value;
            return Trial{.scene = askew(subject(shape))};
          }};
}

/// A trial of the subject scene moved as a whole.
Axis moved_axis(const std::string& id, const std::string& title, const std::string& unit,
                std::vector<double> values, const std::function<Scene(Scene, double)>& move) {
  return {id, title, unit, std::move(values), [move](double value) {
            const Scene still = askew(subject());
            return Trial{.scene = move(still, value), .unmoved = still};
          }};
}

/// Off every grid that an origin may be rounded to.
glm::dvec3 away(double distance) {
  return distance * glm::dvec3(0.61, -0.37, 0.7);
}

Axis stack_axis(const std::string& id, const std::string& title, double thickness,
                std::vector<double> values, double radius, std::uint32_t points) {
  Axis axis{id, title, "plates", std::move(values), [=](double value) {
              const auto count = static_cast<std::uint32_t>(value);
              Scene scene = stack(count, thickness);
              if (radius > 0.0) {
                scene.lights[0].extent = {ExtentKind::disc, radius, glm::dvec2(0.0)};
                scene.lights[0].direction = {0.0, -1.0, 0.0};
                scene.lights[0].outer_angle = 60.0;
                scene.lights[0].inner_angle = 50.0;
              }
              Trial trial{.scene = askew(std::move(scene)), .points = points};
              if (points > 1) trial.width = trial.height = 48;
              return trial;
            }};
  axis.whole = true;
  return axis;
}

}  // namespace

void add_shape_axes(std::vector<Axis>& axes) {
  axes.push_back(moved_axis(
      "scale-up", "scene made larger", "times", {1.0, 1e2, 1e4, 1e6, 1e8, 1e10, 1e11, 1e12, 1e14},
      [](Scene scene, double f) { return moved(std::move(scene), f, 0.0, {}); }));
  axes.push_back(
      moved_axis("scale-down", "scene made smaller", "times",
                 {1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8},
                 [](Scene scene, double f) { return moved(std::move(scene), f, 0.0, {}); }));
  axes.push_back(
      moved_axis("offset", "scene far from the origin", "m", {0.0, 0.3, 1e2, 1e5, 1e8, 1e11},
                 [](Scene scene, double d) { return moved(std::move(scene), 1.0, 0.0, away(d)); }));
  for (const double factor : {1e-3, 1e-4}) {
    const std::string text = factor == 1e-3 ? "1e-3" : "1e-4";
    axes.push_back(moved_axis(
        "offset-of-" + text, "scene of " + text + " times its size, off the origin", "m",
        {0.0, 0.1, 0.3, 0.49, 1.7, 1e2, 1e4, 1e6},
        [factor](Scene scene, double d) { return moved(std::move(scene), factor, 0.0, away(d)); }));
  }
  axes.push_back(moved_axis(
      "rotation", "scene turned about a skew axis", "degrees",
      {0.0, 1e-4, 49.0, 90.0, 139.0, 180.0, 319.0},
      [](Scene scene, double angle) { return moved(std::move(scene), 1.0, angle, {}); }));
  axes.push_back(shape_axis("ground", "half of the ground's side", "m",
                            {6.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8}, &SubjectShape::ground));
  axes.push_back(shape_axis("outlier", "distance of an object out of sight", "m",
                            {0.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e8}, &SubjectShape::outlier));
  axes.push_back(shape_axis("gap", "air under the crate", "m",
                            {0.3, 1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 0.0}, &SubjectShape::gap));
  axes.push_back(shape_axis("thickness", "thickness of the crate", "m",
                            {1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-6}, &SubjectShape::thickness));
  axes.push_back(shape_axis("blade", "width of the post", "m", {0.06, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8},
                            &SubjectShape::post));
  axes.push_back(shape_axis("squash", "factor of the crate's breadth in its matrix", "times",
                            {1.0, 1e-2, 1e-4, 1e-6, 1e-9}, &SubjectShape::squash));
  Axis fan{"fan", "slivers of one disc", "triangles", {16, 64, 256, 1024, 4096}, [](double value) {
             SubjectShape shape;
             shape.slivers = static_cast<std::uint32_t>(value);
             return Trial{.scene = askew(subject(shape))};
           }};
  fan.whole = true;
  axes.push_back(fan);
  Axis copies{"coincident", "crates in one place", "crates", {1, 2, 3, 8}, [](double value) {
                SubjectShape shape;
                shape.copies = static_cast<std::uint32_t>(value);
                return Trial{.scene = askew(subject(shape))};
              }};
  copies.whole = true;
  axes.push_back(copies);
  Axis defects{
      "defects", "ways in which the crate is broken", "", {0, 1, 2, 3, 4, 5, 6}, [](double value) {
        return Trial{.scene = askew(broken_subject(static_cast<Defect>(value)))};
      }};
  defects.names = {"none",       "doubled triangles", "empty triangles", "T-junction",
                   "inside out", "a face turned",     "a face missing"};
  axes.push_back(defects);
  axes.push_back(stack_axis("overlaps", "plates over each other", 0.004,
                            {1, 2, 31, 32, 33, 127, 128, 129, 255, 256, 257, 512, 600}, 0.0, 1));
  axes.push_back(stack_axis("overlaps-soft", "plates over each other under an area light", 0.004,
                            {1, 2, 15, 31, 32, 33, 64, 128, 256}, 0.3, 64));
}

}  // namespace penumbra::experiments::stability
