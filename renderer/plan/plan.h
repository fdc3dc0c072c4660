#pragma once

#include <string>
#include <vector>

#include "renderer/parameters.h"
#include "renderer/render.h"
#include "renderer/technique.h"

namespace penumbra {

/// Of a vertex on the device: its position, and its normal, texture coordinates, colour and facet.
inline constexpr std::uint64_t vertex_bytes = 12 + 36;

/// What of a scene takes part in a render.
struct InstanceUse {
  bool visible = true;  ///< its surfaces are drawn
  bool casts = true;    ///< it may shadow something visible

  friend bool operator==(const InstanceUse&, const InstanceUse&) = default;
};

/// What maps of a light have to tell apart: boxes in the scene's coordinates.
struct LightFit {
  std::vector<Bounds> casters;    ///< what filters of its map may read
  std::vector<Bounds> receivers;  ///< what the camera sees of what it reaches
};

/// A thing of the scene or of the technique, whether the render has it, and why.
struct PlanLine {
  std::string rule;     ///< lights, surfaces, casters, textures, extent, stencil, ...
  std::string subject;  ///< the light's, instance's or texture's name
  bool kept = true;
  std::string reason;
  std::uint64_t bytes = 0;  ///< device memory that it takes, or that its absence saves
};

/// Everything that a render allocates, uploads and draws, decided before any of it happens. Made of
/// boxes, cones and hulls on the safe side: what it drops cannot change a pixel.
struct Plan {
  std::vector<InstanceUse> instances;
  std::vector<bool> lights;         ///< whether the light reaches anything visible
  std::vector<Requirements> needs;  ///< of the technique for each light
  std::vector<LightFit> fits;       ///< for each light
  std::vector<bool> textures;       ///< whether any drawn surface or masked caster reads it
  std::vector<PlanLine> lines;
};

/// Boxes of all instances, world space, in order; padded for the rounding of single precision.
std::vector<Bounds> instance_boxes(const Scene& scene);

/// What the technique of a request requires of each light; `boxes` are the scene's
/// instance_boxes(). Passes on its `unsupported`.
std::vector<Requirements> requirements_of(const RenderRequest& request,
                                          const ParameterValues& parameters,
                                          const std::vector<Bounds>& boxes);

/// The plan of a request. `parameters` are complete. Asks the technique what each light requires
/// and passes on its `unsupported`. `through`: a camera in place of the picture's, or null. Where
/// frames of other cameras go first everything is kept: what one does not see the next may.
Plan make_plan(const RenderRequest& request, const ParameterValues& parameters,
               const std::vector<Bounds>& boxes, const Camera* through = nullptr);

}  // namespace penumbra
