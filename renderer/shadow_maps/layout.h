#pragma once

#include <functional>
#include <string>
#include <vector>

#include "renderer/frame/gpu_scene.h"
#include "renderer/scene/light_points.h"
#include "renderer/scene/transforms.h"
#include "renderer/shaders/shader_types.h"
#include "renderer/technique.h"

namespace penumbra::shadow_maps {

/// How a filter reads a map.
struct MapUse {
  double kernel_radius = 0.0;  ///< texels that it reads from the receiver's place; the bias follows
  double border = kernel_radius;  ///< texels by which a view is wider than what it serves
  bool follows_extent = false;    ///< it reads as far as the penumbra of the light's extent
  bool common_range = false;      ///< it averages coded depths: those of all views must agree
};

/// What a layout fits its views to.
struct ViewFitting {
  const GpuScene& scene;
  const Bounds& scene_box;  ///< as TechniqueInput's
  const WorldLight& light;
  const LightFit& fit;
  const CameraMatrices& camera;  ///< of the whole picture, whatever window of it is drawn
  const ParameterValues& parameters;
  const MapUse& use;
  std::uint32_t size;  ///< texels along a side of a view
  /// SeenSamples::bounds.
  std::function<std::vector<Bounds>(const std::vector<shader::MapView>&, bool by_depth)>
      seen_bounds;
  std::vector<std::string>& notes;  ///< shown with the result
};

/// How a layout of tiles finds out which of them matter, if it has tiles.
enum class TileRanking {
  none,            ///< views of map_size, in the layers of an image
  read_back,       ///< from what this frame sees, which the host waits for
  previous_frame,  ///< from what the last frame saw; the host waits in the first one only
  on_device        ///< from what this frame sees, without the host
};

/// Where depth lives: which views of the scene a light's map has, and which of them tell of a
/// receiver. A layout is layouts/<id>.cpp, which describes this, and layouts/<id>.glsl, which
/// defines `ViewChoice choose_views(vec3 position)`; the build finds them.
struct Layout {
  std::string id;                     ///< value of parameter `layout`, and name of the files
  std::string meaning;                ///< a few words in that parameter's description
  std::vector<Parameter> parameters;  ///< its own; without a variant, so that none costs a compile
  std::vector<LightKind> serves;      ///< kinds of light that it is for
  std::function<std::uint32_t(const TechniqueInput&)> view_count;
  std::function<std::vector<shader::MapView>(const ViewFitting&)> fit;
  std::function<bool(const Light&, const ParameterValues&)>
      warps;                   ///< whether views may be warped; without it none is
  bool reads_samples = false;  ///< it asks for `seen_bounds`
  TileRanking ranking = TileRanking::none;
};

/// For Layout::warps of those that fit views to what is seen: a crop is a warp, too.
inline bool always_warps(const Light&, const ParameterValues&) {
  return true;
}

inline constexpr const char* default_layout = "single";

/// In order of id, but the default first.
const std::vector<Layout>& layouts();

bool serves(const Layout& layout, LightKind kind);

/// Throws unsupported, naming the light, unless the layout serves it.
void require_served(const Layout& layout, const Light& light);

/// Ids of those that serve lights of a kind.
std::vector<std::string> layouts_for(LightKind kind);

/// The one that parameter `layout` names.
const Layout& chosen_layout(const ParameterValues& parameters);

/// GLSL that tells what is known of the views before they are fitted: that there is one, that none
/// is warped. Pictures are the same without it.
std::string view_definitions(const TechniqueInput& input);

/// Throws std::logic_error where views are not as view_definitions told.
void check_views(const TechniqueInput& input, const std::vector<shader::MapView>& views);

}  // namespace penumbra::shadow_maps
