#pragma once

#include <vector>

#include "renderer/frame/light_points.h"
#include "renderer/scene/gpu_scene.h"
#include "renderer/shaders/shader_types.h"

namespace penumbra::shadow_maps {

/// How a light sees the scene: one face for spot and directional lights, six for point lights and
/// wide spot lights.
struct LightView {
  std::vector<shader::MapFace> faces;
  float near_distance = 0.0f;  ///< metres along a face's forward axis
  float far_distance = 1.0f;
};

/// Faces of a light's view.
std::uint32_t face_count(const Light& light);

/// Fits the view to what the scene needs: a spot light's cone, the scene's box for a directional
/// light; within the side planes from the nearest of `fit`'s boxes to its farthest receiver (van
/// Sambeek 2007, 2.2.3). Casters before near are clamped to it when drawn with depth clamp, and so
/// are those beyond far, which shadow nothing. `guard` widens the map by this share of its width on
/// each side, room for filter kernels.
LightView fit_light_view(const GpuScene& scene, const WorldLight& light, const LightFit& fit,
                         std::uint32_t map_size, double guard);

}  // namespace penumbra::shadow_maps
