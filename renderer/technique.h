#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "renderer/embedded_file.h"
#include "renderer/parameters.h"
#include "renderer/scene/scene.h"

namespace penumbra {

struct RenderRequest;  // renderer/render.h
class PrepareContext;  // renderer/frame/prepare_context.h: what a technique may use while it draws
struct SampleList;     // renderer/frame/sample_list.h: samples of the frame
namespace vulkan {
class Bindings;  // renderer/vulkan/pipeline.h: shader resources by name
}

/// What is known of a light's task before anything is allocated.
struct TechniqueInput {
  const Scene& scene;
  Bounds scene_box;  ///< around all instances, in the scene's coordinates
  const Light& light;
  const Camera& camera;
  const ParameterValues& parameters;  ///< complete: every declared parameter has a value
  std::uint32_t width;                ///< samples of the geometry buffer, supersampling included
  std::uint32_t height;
  std::uint32_t light_samples;
  std::uint64_t seed;
};

/// What a light's task is in a picture; `parameters` are complete.
TechniqueInput technique_input(const RenderRequest& request, const Bounds& scene_box,
                               const Light& light, const Camera& camera,
                               const ParameterValues& parameters);

/// Which instances may change what a technique returns for the surfaces that are seen.
enum class CasterUse {
  none,  ///< none at all
  beam,  ///< those between light and surface: exact for every point
  cone,  ///< those in the light's cone and around it: neighbouring directions are mixed
  all    ///< every one, wherever it is
};

/// Filters of a spot light's map read no further than this many times the cone's width.
constexpr double widest_filtered_cone = 2.0;

/// Something that a technique allocates for a light and whose size follows from parameters.
struct MemoryNeed {
  std::string name;          ///< as in the memory report
  std::uint64_t bytes = 0;   ///< at least
  std::uint32_t extent = 0;  ///< texels along an edge of an image; 0: a storage buffer
  std::string parameter;     ///< that sets the size
};

/// Name of the requirement that scenes keep one structure for (GpuScene::derived_memory).
inline constexpr const char* acceleration_structure_name = "acceleration structure";

/// What a technique needs for one light; the plan allocates this and nothing else.
struct Requirements {
  std::vector<MemoryNeed>
      memory;  ///< what may be too large for a device; not images of the frame's size
  CasterUse casters = CasterUse::cone;
  bool reads_sky = true;   ///< its own passes read the geometry buffer, also where no surface is
  bool stencil = false;    ///< a stencil plane beside the geometry buffer's depth
  bool adjacency = false;  ///< index buffer of triangles with adjacency
  bool acceleration_structure = false;  ///< bounding volume hierarchy over the casters
  std::uint32_t light_points = 1;  ///< points on the extent asked for one by one; 1: its centre
  bool shade_each_point = false;   ///< light from each point, not from the centre
  bool random_points = false;      ///< points from a seeded generator, not low-discrepancy
  bool scrambles = false;          ///< points in 16 independent sets, whose spread tells the error
  std::string definitions;  ///< lines of GLSL before its programs, beside parameters: what is known
                            ///< of the light need not be asked for every sample
};

/// A way to find the visibility of one light. An instance serves one light of one render; the core
/// calls require once, then per frame and batch of light points: prepare, bind, and for every pixel
/// the technique's GLSL function `float calculate_shadow(ShadowQuery)` (1 lit, 0 occluded).
class Technique {
 public:
  virtual ~Technique() = default;

  /// Declares needs. Throws `unsupported` with the reason where light or scene cannot be served.
  virtual void require(const TechniqueInput& input, Requirements& needs) = 0;

  /// Records whatever must exist before shading: a map, a mask, a table.
  virtual void prepare(PrepareContext& context) = 0;

  /// Names the resources that the GLSL reads; checked both ways against reflection.
  virtual void bind(vulkan::Bindings& bindings) const = 0;

  /// For techniques of many light points: the samples that any of the light reaches, where prepare
  /// found out in the first batch. Others are not shaded. Null: all are.
  virtual const SampleList* lit_samples() const { return nullptr; }
};

struct Diagnostic {
  std::string name;
  std::string meaning;
  bool of_uncertainty = false;  ///< reads the scrambles' sums: drawn only where those are known
};

struct TechniqueDescription;

/// The diagnostic picture of that name, or null for an empty one. Throws bad_value for a name that
/// the technique does not have, telling those that it has.
const Diagnostic* find_diagnostic(const TechniqueDescription& technique, const std::string& name);

/// Everything the rest of the program knows of a technique. Built by `describe_<folder>()`.
struct TechniqueDescription {
  std::string id;      ///< the folder's name; filled in by the registry
  std::string label;   ///< abbreviation in reports, as the source has it
  std::string title;   ///< a person's words
  std::string family;  ///< none, planar, map, volume, hybrid, receiver, traced, truth
  std::string source;  ///< paper or thesis section
  std::vector<Parameter> parameters;
  std::vector<Diagnostic> diagnostics;  ///< pictures by name, from `vec4 draw_diagnostic_<name>`
  std::string shader;  ///< path of the GLSL that defines calculate_shadow; default: shadow.glsl
                       ///< in the folder
  std::span<const EmbeddedFile> files;  ///< all techniques' shaders; filled in by the registry
  std::function<std::unique_ptr<Technique>()> create;
};

/// What most descriptions have as `create`.
template <class T>
std::unique_ptr<Technique> create_technique() {
  return std::make_unique<T>();
}

}  // namespace penumbra
