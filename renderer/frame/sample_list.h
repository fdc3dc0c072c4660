#pragma once

#include "renderer/vulkan/commands.h"
#include "renderer/vulkan/texel_view.h"

namespace penumbra {

/// Push constants of passes that work at samples, as renderer/shaders/sample_list.glsl has them.
struct SampleWork {
  std::uint32_t first = 0;  ///< of a list
  std::uint32_t count = 0;
  std::uint32_t set = 0;     ///< place of the samples in their pixels, 0 .. samples per pixel - 1
  std::uint32_t nodes = 0;   ///< of the hierarchy that is walked
  std::uint32_t rounds = 0;  ///< most of a walk in one dispatch
  std::uint32_t slot = 0;    ///< of the first sample among those that keep something of their own
};

/// Samples of the frame that a pass has to work at.
struct SampleList {
  vulkan::TexelBuffer texels;  ///< a word each: x, and y in the upper half
  struct Range {
    std::uint32_t set;
    std::uint32_t first;
    std::uint32_t count;
    bool fully_lit = false;  ///< nothing hides any of the light: few points tell how it shines
  };
  std::vector<Range> ranges;  ///< within each all samples have the same place in their pixels
};

/// Runs the bound compute program, which includes sample_list.glsl and was compiled with
/// WITH_SAMPLE_LIST, at a range of a list.
void dispatch_range(vulkan::Commands& commands, const SampleList::Range& range,
                    SampleWork work = {});

/// Runs it, compiled without, at all samples of one place in their pixels.
void dispatch_all(vulkan::Commands& commands, std::uint32_t width, std::uint32_t height,
                  std::uint32_t side, SampleWork work);

}  // namespace penumbra
