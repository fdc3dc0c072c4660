#pragma once

#include <optional>
#include <vector>

#include "renderer/shadow_maps/layout.h"

/// What layouts make their views of.
namespace penumbra::shadow_maps {

/// Where a view looks, and what is up on it.
struct ViewAxes {
  glm::dvec3 forward;
  glm::dvec3 up;
  glm::dvec3 right() const { return glm::cross(forward, up); }
};

/// A view without a range yet, `half_width` to each side: metres for parallel rays, tangents for
/// those from one point. `size` in texels.
shader::MapView make_view(const glm::dvec3& origin, const ViewAxes& axes, double half_width,
                          bool perspective, double size);

/// Whether a light shines so wide that six views around it are needed: one view of it would have
/// few texels left for its middle, and none beyond a right angle.
bool has_six_views(const Light& light);

/// A square view from a light, and the tangent of its half angle.
struct AimedView {
  ViewAxes axes;
  double tangent;
};

/// The view that holds a box, where its texels are no wider in its middle than those of six views
/// around the place are there: one then serves better than six. None where the place is within the
/// box or too near.
std::optional<AimedView> view_of_box(const Bounds& box, const glm::dvec3& place);

/// The view over a spot light's cone, or the six around a light that needs them; `widen` as wide.
std::vector<shader::MapView> views_around(const WorldLight& light, double widen, double size);

/// Axes of a view from a light, `down` leading towards growing v; it need be neither unit nor
/// across.
ViewAxes axes_with_down(const WorldLight& light, const glm::dvec3& down);

/// Lets a view lose what lies outside a half-space, as one does that is drawn with depth cut off
/// there: for showing what that costs.
void cut_casters(shader::MapView& view, const glm::dvec4& kept);
bool cuts_casters(const shader::MapView& view);

/// Bends the plane across the view's axis: the view's clip coordinates x, y, w are multiplied by
/// `warp`. w stays above 0 over what is to be seen.
void warp_view(shader::MapView& view, const glm::dmat3& warp, double size);
bool is_warped(const shader::MapView& view);

/// Share of its width by which a view is widened on each side for the filter.
double guard_share(const MapUse& use, std::uint32_t size);

/// What a directional light's views may have to cover: the whole scene, or what is seen of it where
/// it reaches too far.
Bounds covered_box(const GpuScene& scene, const LightFit& fit);

/// Bounds of a box along the axes: x right, y up, z forward.
Bounds bounds_along(const Bounds& box, const ViewAxes& axes);

/// Gives views the range that the scene needs: within a view's side planes from the nearest of
/// `fit`'s boxes to its farthest receiver (van Sambeek 2007, 2.2.3). Casters before near are
/// clamped to it when drawn with depth clamp, and so are those beyond far, which shadow nothing.
/// `common`: one range for all.
void fit_ranges(std::vector<shader::MapView>& views, const GpuScene& scene, const LightFit& fit,
                bool common);

/// Gives views the range from the light, or from where directional lights' views begin, to the far
/// end of the scene, whatever is seen of it.
void fix_ranges(std::vector<shader::MapView>& views, const GpuScene& scene, const LightFit& fit);

/// Gives views that show samples of what is seen (SeenSamples::bounds) the range of these, so that
/// casters before them are clamped onto near. `use` and `slope_scale` tell what comparisons grant,
/// `bias` m more. `use.common_range`: one range for all.
void fit_ranges_to(std::vector<shader::MapView>& views, const std::vector<Bounds>& seen,
                   const MapUse& use, double slope_scale, double bias, double size);

/// Gives a view a range that was fitted from near to far, m along its axis, a little wider and
/// nowhere behind where the view begins.
void set_fitted_range(shader::MapView& view, double near, double far);

/// The range that parameters ask for in place of what was fitted.
void set_given_range(shader::MapView& view, const ParameterValues& parameters);

/// Moves the origin of a view whose light is far from the scene, beside the scene's size, and
/// counts its range from there, so that depth is a float of what the scene spans.
void count_from_scene(shader::MapView& view, const GpuScene& scene,
                      const ParameterValues& parameters);

/// The range of a view from near to far, m along its axis.
void set_range(shader::MapView& view, float near, float far);

}  // namespace penumbra::shadow_maps
