#include "scenes/import/polygon.h"

#include <GL/glu.h>

#include <deque>
#include <memory>
#include <optional>

namespace penumbra::scenes {
namespace {

/// Twice the area, along the normal of the plane that fits best (Newell).
glm::dvec3 newell_normal(std::span<const glm::dvec3> polygon) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum += glm::cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  return sum;
}

/// Two triangles of a quad that is convex, cut along its shorter diagonal where both cuts do.
std::optional<std::vector<std::uint32_t>> cut_quad(std::span<const glm::dvec3> quad) {
  const glm::dvec3 normal = newell_normal(quad);
  const auto faces_it = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return glm::dot(glm::cross(quad[b] - quad[a], quad[c] - quad[a]), normal) > 0.0;
  };
  const bool from_first = faces_it(0, 1, 2) && faces_it(0, 2, 3);
  const bool from_second = faces_it(1, 2, 3) && faces_it(1, 3, 0);
  const bool first_shorter = glm::distance(quad[0], quad[2]) <= glm::distance(quad[1], quad[3]);
  if (from_first && (first_shorter || !from_second))
    return std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3};
  if (from_second) return std::vector<std::uint32_t>{1, 2, 3, 1, 3, 0};
  return {};
}

struct Tessellation {
  std::span<const glm::dvec3> polygon;
  const std::function<void(const CornerShares&)>* crossing = nullptr;
  Triangulation result;
  std::deque<std::uint32_t> numbers;  ///< the library hands back addresses of these
  std::vector<glm::dvec3> added;      ///< positions of crossings

  glm::dvec3 position(std::uint32_t number) const {
    return number < polygon.size() ? polygon[number] : added[number - polygon.size()];
  }
};

void on_vertex(void* number, void* state) {
  static_cast<Tessellation*>(state)->result.corners.push_back(
      *static_cast<const std::uint32_t*>(number));
}

/// Makes the library send separate triangles.
void on_edge(GLboolean) {}

/// Two corners at a place become one; where edges cross a corner is added.
void on_combine(GLdouble*, void* from[4], GLfloat weights[4], void** out, void* state) {
  auto& work = *static_cast<Tessellation*>(state);
  const auto number = [&](int i) { return *static_cast<const std::uint32_t*>(from[i]); };
  bool together = true;
  for (int i = 1; i < 4; ++i)
    if (from[i] != nullptr)
      together = together && work.position(number(i)) == work.position(number(0));
  if (together) {
    *out = from[0];
    return;
  }
  CornerShares shares{};
  glm::dvec3 position(0.0);
  for (int i = 0; i < 4; ++i) {
    if (from[i] == nullptr) continue;
    shares[static_cast<std::size_t>(i)] = {number(i), static_cast<double>(weights[i])};
    position += static_cast<double>(weights[i]) * work.position(number(i));
  }
  work.result.crosses_itself = true;
  work.numbers.push_back(static_cast<std::uint32_t>(work.polygon.size() + work.added.size()));
  work.added.push_back(position);
  (*work.crossing)(shares);
  *out = &work.numbers.back();
}

template <class Function>
void listen(GLUtesselator* tessellator, GLenum what, Function* function) {
  gluTessCallback(tessellator, what, reinterpret_cast<void (*)()>(function));
}

}  // namespace

Triangulation triangulate(std::span<const glm::dvec3> given,
                          const std::function<void(const CornerShares&)>& crossing) {
  Triangulation result;
  if (given.size() == 3) {
    result.corners = {0, 1, 2};
    return result;
  }
  // A corner that repeats the one before it is no corner.
  std::vector<glm::dvec3> polygon;
  std::vector<std::uint32_t> number_of;
  for (std::uint32_t i = 0; i < given.size(); ++i) {
    if (!polygon.empty() && given[i] == polygon.back()) continue;
    polygon.push_back(given[i]);
    number_of.push_back(i);
  }
  while (polygon.size() > 1 && polygon.back() == polygon.front()) {
    polygon.pop_back();
    number_of.pop_back();
  }
  if (polygon.size() < 3) return result;
  if (polygon.size() == 3) {
    result.corners = number_of;
    return result;
  }
  if (polygon.size() == 4) {
    if (const auto corners = cut_quad(polygon)) {
      for (const std::uint32_t corner : *corners) result.corners.push_back(number_of[corner]);
      return result;
    }
  }

  Tessellation work{given, &crossing, {}, {}, {}};
  const std::unique_ptr<GLUtesselator, decltype(&gluDeleteTess)> tessellator(gluNewTess(),
                                                                             gluDeleteTess);
  if (!tessellator) throw std::bad_alloc();
  listen(tessellator.get(), GLU_TESS_VERTEX_DATA, on_vertex);
  listen(tessellator.get(), GLU_TESS_EDGE_FLAG, on_edge);
  listen(tessellator.get(), GLU_TESS_COMBINE_DATA, on_combine);
  gluTessProperty(tessellator.get(), GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_NONZERO);
  // Halves that cancel each other, as in a bow tie, have no normal: the library then takes its own.
  const glm::dvec3 normal = newell_normal(polygon);
  double longest = 0.0;
  for (const glm::dvec3& corner : polygon)
    longest = std::max(longest, glm::distance(corner, polygon[0]));
  if (glm::length(normal) > 1e-9 * longest * longest)
    gluTessNormal(tessellator.get(), normal.x, normal.y, normal.z);
  gluTessBeginPolygon(tessellator.get(), &work);
  gluTessBeginContour(tessellator.get());
  for (const std::uint32_t number : number_of) {
    work.numbers.push_back(number);
    const glm::dvec3 offset = given[number] - polygon[0];
    GLdouble coordinates[3] = {offset.x, offset.y, offset.z};
    gluTessVertex(tessellator.get(), coordinates, &work.numbers.back());
  }
  gluTessEndContour(tessellator.get());
  gluTessEndPolygon(tessellator.get());
  return std::move(work.result);
}

}  // namespace penumbra::scenes
