#pragma once

#include <functional>
#include <limits>

#include "renderer/shadow_maps/views/light_view.h"
#include "renderer/shadow_maps/views/seen.h"

/// Views that are focused on what the camera sees, and bent so that what is near the camera gets
/// more texels.
namespace penumbra::shadow_maps {

/// True for a camera with an eye, false for an orthographic one.
bool has_eye(const CameraMatrices& camera);

/// Places on a plain view, in units of half its width, y downwards; or of its plane, m.
struct SeenPlaces {
  std::vector<glm::dvec2> points;  ///< which span what is to be seen
  glm::dvec2 low{std::numeric_limits<double>::infinity()};
  glm::dvec2 high{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec2& point) {
    points.push_back(point);
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  glm::dvec2 size() const { return high - low; }
};

/// Points that span what the camera sees of the receivers in a slice; where that is nothing, of
/// what the light may reach of it.
std::vector<glm::dvec3> seen_points(const ViewFitting& fitting, const Slice& slice);

/// A plain view of a directional light around what is seen, without a range.
struct FocusedView {
  shader::MapView view;
  SeenPlaces seen;
  double half;        ///< of its width, m
  glm::dvec2 center;  ///< along the axes' right and against their up, m
};
FocusedView focused_view(const ViewFitting& fitting, const ViewAxes& axes,
                         const std::vector<glm::dvec3>& points);

/// The perspective picture that a plain view is bent to, y away from its eye, in the view's units:
/// where the eye lies across, and how far before the nearest place seen. Infinite: no bend.
struct Bend {
  double across;
  double before;
};

/// Bends a plain view, and moves and scales it so that what is seen fills it, but for what its
/// filter reads beyond: texels, and `reach` in the view's units where it follows the light's
/// extent.
void bend_and_fill(shader::MapView& view, const SeenPlaces& seen, const Bend& bend, double reach,
                   const ViewFitting& fitting);

/// Notes the share of a view's texels that lie between points that span what is seen: the others
/// are wasted.
void note_used_texels(const ViewFitting& fitting, const shader::MapView& view,
                      const std::vector<glm::dvec3>& points);

/// What a warp may depend on.
struct WarpInput {
  Slice seen;     ///< along the camera's direction
  double length;  ///< m of what is seen along that direction, across the light's
  double sine;    ///< of the angle between the camera's direction and the light's
};

/// One view of a directional light whose texels are spread as a perspective picture has them that
/// is taken across the light's direction, along the camera's, from as many metres before the
/// nearest place seen as `distance` returns. Infinite: evenly. A light is mapped along itself, so
/// that casters keep the place of what they shadow, wherever they stand. Evenly too where the
/// camera is orthographic or looks along the light.
std::vector<shader::MapView> fit_warped(const ViewFitting& fitting,
                                        const std::function<double(const WarpInput&)>& distance);

}  // namespace penumbra::shadow_maps
