#pragma once

#include "renderer/frame/common_parameters.h"
#include "renderer/frame/geometry_buffer.h"
#include "renderer/frame/gpu_scene.h"
#include "renderer/vulkan/commands.h"

namespace penumbra {

/// Allocates the geometry buffer for this many samples; stencil and emitted light only where asked
/// for.
GeometryBuffer make_geometry_buffer(vulkan::Device& device, vulkan::MemoryLedger& ledger,
                                    std::uint32_t width, std::uint32_t height, bool stencil,
                                    bool emitted);

/// Draws the scene into the geometry buffer. Colours are decoded from sRGB as `gamma` says. Where
/// no surface is, the buffer holds zeros if it `marks_sky`, otherwise anything.
void draw_geometry(vulkan::Commands& commands, vulkan::PipelineCache& pipelines,
                   const GpuScene& scene, const GeometryBuffer& buffer,
                   const vulkan::Bindings& frame_bindings, const glm::mat4& clip_from_world,
                   const GammaTreatment& gamma, bool marks_sky);

}  // namespace penumbra
