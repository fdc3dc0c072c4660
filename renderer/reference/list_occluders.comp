// Writes down, for samples in penumbrae that have few of them, the triangles that may hide any of the light,
// and which batches of its points: one bit each, or for some neighbours together.
#include "renderer/reference/occluder_lists.glsl"
#include "renderer/reference/walk.glsl"
#include "renderer/shaders/unroll.glsl"

layout(r32ui) uniform uimage2DArray candidates;
layout(std140) uniform BatchBoxBlock { BatchBox batch_boxes[batch_bits]; };

layout(std430) buffer CounterBlock {
  uint occluders_used;  // places of all lists
  uint overfull_lists;
};

vec3 middles[batch_bits];
vec3 half_sizes[batch_bits];

void read_boxes() {
#define READ(i) middles[i] = batch_boxes[i].middle.xyz; half_sizes[i] = batch_boxes[i].half_size.xyz;
  UNROLL_32(READ)
#undef READ
}

// x the batches of which the triangle may hide points, y those that it hides as a whole. As `classify`, for
// boxes within that of the light.
uvec2 hidden_batches(Shaft light, TrianglePlanes t) {
  vec4 planes[4] = vec4[4](t.edges[0], t.edges[1], t.edges[2], t.beyond);
  vec3 farthest = abs(light.middle) + light.half_size;
  vec3 sizes[4];
  float margins[4];
  for (int k = 0; k < 4; ++k) {
    sizes[k] = abs(planes[k].xyz);
    margins[k] = range_margin(planes[k], farthest);
  }
  uint any = 0u, all = 0u;
#define BATCH(i)                                                           \
  {                                                                        \
    uint misses = 0u, borders = 0u;                                        \
    for (int k = 0; k < 4; ++k) {                                          \
      float value = at(planes[k], middles[i]);                             \
      float spread = dot(sizes[k], half_sizes[i]) + margins[k];            \
      misses |= floatBitsToUint(value + spread);                           \
      borders |= floatBitsToUint(value - spread);                          \
    }                                                                      \
    any = any >> 1 | (~misses & 0x80000000u);                              \
    all = all >> 1 | (~borders & 0x80000000u);                             \
  }
  UNROLL_32(BATCH)
#undef BATCH
  return uvec2(any, all);
}

void main() {
  ivec2 texel;
  bool inside = find_sample(texel);
  read_boxes();
  Shaft shaft = shaft_to_light(read_receiver(texel));
  if (!inside) return;
  uint most = occlusion_masks[mask_place(texel)];  // the sample's class: as many triangles as were found
#ifdef RESUMED
  OccluderList list = read_list();
#else
  OccluderList list = OccluderList(atomicAdd(occluders_used, most), 0u, 0u);
#endif
  uint end = imageLoad(candidates, ivec3(texel, 1)).r;
  uint node = begin_walk(texel, imageLoad(candidates, ivec3(texel, 0)).r);
  while (node < end && list.count <= most && rounds_left > 0) {
    --rounds_left;
    int found_triangle = next_leaf(shaft, node, end);
    uint triangle = uint(max(found_triangle, 0));
    TrianglePlanes planes = planes_of(shaft, triangle);
    bool hides = found_triangle >= 0 && classify(shaft, planes) != hides_none;
    uvec2 batches = hidden_batches(shaft, planes);
#ifdef WITH_HOLES
    batches.y = texelFetch(hierarchy_triangles, int(3u * triangle)).w == all_hidden ? batches.y : 0u;
#endif
    if (hides && list.count < most) occluders[list.first + list.count] = uvec2(triangle, batches.x & ~batches.y);
    list.hidden |= hides ? batches.y : 0u;
    list.count += hides ? 1u : 0u;
  }
  end_walk(texel, node, node >= end || list.count > most);
  // A compiler that rounds otherwise here may find one more: then lists are not used.
  if (list.count > most) atomicAdd(overfull_lists, 1u);
  write_list(list);
}
