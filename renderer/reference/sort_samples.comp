// Lists the samples that light reaches, ordered by the class that find_occluders.comp wrote as their mask:
// neighbours in the list have about as much to look at, and lanes that run in step do not wait for one
// another.
#include "renderer/reference/mask_place.glsl"
#include "renderer/shaders/sample_list.glsl"

layout(std140) uniform StartBlock { uvec4 starts[sample_classes]; };  // x where in the list a class begins
layout(std430) buffer ClassBlock { uint class_counts[]; };            // by set and class; from 0 on again
layout(std430) buffer ListedBlock { uint listed[]; };
layout(std430) buffer MaskBlock { uint occlusion_masks[]; };

shared uint group_counts[sample_classes];
shared uint group_starts[sample_classes];

void main() {
  ivec2 texel;
  bool inside = find_sample(texel);
  uint lane = gl_LocalInvocationIndex;
  for (uint i = lane; i < uint(sample_classes); i += 64u) group_counts[i] = 0u;
  barrier();
  uint kind = inside ? occlusion_masks[mask_place(texel)] : 0xffffffffu;
  bool is_lit = kind < uint(sample_classes);
  uint place = is_lit ? atomicAdd(group_counts[kind], 1u) : 0u;
  barrier();
  // Samples of a workgroup stay together.
  for (uint i = lane; i < uint(sample_classes); i += 64u)
    if (group_counts[i] > 0u)
      group_starts[i] = starts[i].x + atomicAdd(class_counts[work.set * uint(sample_classes) + i], group_counts[i]);
  barrier();
  if (is_lit) listed[group_starts[kind] + place] = uint(texel.x) | uint(texel.y) << 16;
}
