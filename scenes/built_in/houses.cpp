#include <cmath>

#include "scenes/built_in/outdoors.h"
#include "scenes/generators/random.h"

namespace penumbra::scenes {
namespace {

constexpr double storey_height = 2.8;

/// A window that stands a few centimetres out of the wall z = 0, its middle at (0, 0): in detail a
/// frame around four panes, otherwise two panes on a board.
void add_window(Mesh& mesh, const HouseLooks& looks, bool fine, const glm::dmat4& at) {
  if (fine) {
    add_part(mesh,
             plate({-0.55, -0.47, -0.03, 0.03, 0.47, 0.55}, {-0.7, -0.62, 0.08, 0.14, 0.62, 0.7},
                   {{1, 1}, {3, 1}, {1, 3}, {3, 3}}, 0.12),
             looks.timber, at);
    add_part(mesh, box({-0.5, -0.65, -0.08}, {0.5, 0.65, 0.02}), looks.glass, at);
  } else {
    add_part(mesh, box({-0.55, -0.7, -0.06}, {0.55, 0.7, 0.05}), looks.timber, at);
    for (const double x : {-0.25, 0.25})
      add_part(mesh, box({x - 0.21, -0.62, -0.05}, {x + 0.21, 0.62, 0.06}), looks.glass, at);
  }
  add_part(mesh, box({-0.68, -0.79, -0.05}, {0.68, -0.715, 0.16}), looks.timber, at);
}

void add_door(Mesh& mesh, const HouseLooks& looks, const glm::dmat4& at) {
  add_part(mesh, box({-0.52, 0.0, -0.08}, {0.52, 2.1, 0.05}), looks.timber, at);
  for (const double x : {-0.62, 0.62})
    add_part(mesh, box({x - 0.09, -0.01, -0.07}, {x + 0.09, 2.19, 0.09}), looks.wall, at);
  add_part(mesh, box({-0.75, 2.2, -0.06}, {0.75, 2.36, 0.11}), looks.wall, at);
  add_part(mesh, box({-0.85, -0.04, -0.05}, {0.85, 0.14, 0.62}), looks.wall, at);
}

/// Windows of one side, `count` a storey; where `door` is set, the middle of the ground floor is
/// free of them.
void add_side(Mesh& mesh, const HouseForm& form, const HouseLooks& looks, int count, double length,
              bool door, const glm::dmat4& at) {
  for (int storey = 0; storey < form.storeys; ++storey)
    for (int i = 0; i < count; ++i) {
      if (door && storey == 0 && i == count / 2) continue;
      const double x = length * ((i + 0.5) / count - 0.5);
      add_window(mesh, looks, form.fine, at * move({x, storey_height * storey + 1.6, 0.0}));
    }
  if (door) add_door(mesh, looks, at * move({length * ((count / 2 + 0.5) / count - 0.5), 0, 0}));
}

}  // namespace

void add_house(Mesh& mesh, const HouseForm& form, const HouseLooks& looks,
               const glm::dmat4& place) {
  const double eaves = storey_height * form.storeys + 0.35, half = 0.5 * form.depth;
  const double ridge = eaves + form.pitch * half;
  // Both the walls' outline and the roof's are swept along x: polygons in (-z, y).
  const glm::dmat4 along = place * turn_y(90.0);
  add_part(mesh,
           extrude({{-half, -0.2}, {half, -0.2}, {half, eaves}, {0.0, ridge}, {-half, eaves}},
                   form.width),
           looks.wall, along);
  const double over = 0.45, thick = 0.16, drop = form.pitch * over;
  add_part(mesh,
           extrude({{-half - over, eaves - drop + 0.01},
                    {0.0, ridge + 0.01},
                    {half + over, eaves - drop + 0.01},
                    {half + over, eaves - drop + thick},
                    {0.0, ridge + thick + 0.05},
                    {-half - over, eaves - drop + thick}},
                   form.width + 0.7),
           looks.roof, along, 20.0);
  if (form.chimney) {
    const double x = 0.28 * form.width;
    add_part(mesh, box({x - 0.3, ridge - 1.2, -0.75}, {x + 0.3, ridge + 0.9, -0.2}), looks.wall,
             place);
    add_part(mesh, box({x - 0.38, ridge + 0.905, -0.83}, {x + 0.38, ridge + 1.0, -0.12}),
             looks.timber, place);
  }
  const int wide = static_cast<int>(std::lround(form.width / 2.2)) | 1;
  const int deep = static_cast<int>(std::lround(form.depth / 2.6));
  add_side(mesh, form, looks, wide, form.width, true, place * move({0.0, 0.0, half}));
  add_side(mesh, form, looks, wide, form.width, false,
           place * turn_y(180.0) * move({0.0, 0.0, half}));
  for (const double turn : {90.0, 270.0})
    add_side(mesh, form, looks, deep, form.depth, false,
             place * turn_y(turn) * move({0.0, 0.0, 0.5 * form.width}));
}

void add_fence(Mesh& mesh, const glm::dvec3& from, const glm::dvec3& to, const Look& wood) {
  const double length = glm::length(to - from);
  const int posts = static_cast<int>(std::ceil(length / 2.0));
  const glm::dvec3 step = (to - from) / static_cast<double>(posts);
  const glm::dvec3 along = glm::normalize(step);
  for (int i = 0; i <= posts; ++i)
    add_part(mesh, cylinder(0.06, 0.055, 1.35, 8), wood,
             move(from + static_cast<double>(i) * step - glm::dvec3(0.0, 0.2, 0.0)), 40.0);
  for (const double y : {0.45, 0.95})
    add_part(mesh,
             bar(from + glm::dvec3(0.0, y, 0.0) - 0.1 * along,
                 to + glm::dvec3(0.0, y, 0.0) + 0.1 * along, 0.05, 0.11),
             wood);
}

void add_sky(Scene& scene) {
  scene.ambient = {0.17f, 0.20f, 0.25f};
  scene.background_low = {0.66f, 0.76f, 0.86f};
  scene.background_high = {0.22f, 0.40f, 0.68f};
}

}  // namespace penumbra::scenes
