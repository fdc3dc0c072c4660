// Writes, for samples of the frame, which points of the batch are hidden: bit i for point i. With
// FIND_CANDIDATES it looks at the whole light once instead, tells samples apart that all, none or part
// of it reaches, and notes for the last the first and last triangle that may hide any of it: batches
// look at those samples only, and nowhere else. LIST_OCCLUDERS then writes down these triangles, where
// they are not too many, so that batches (with OCCLUDERS_LISTED) need not walk at all.
#include "renderer/reference/intersector.glsl"
#include "renderer/shaders/faults.glsl"
#include "renderer/shaders/lighting.glsl"
#include "renderer/shaders/light_points.glsl"
#include "renderer/shaders/sample_list.glsl"
#include "renderer/shaders/texel.glsl"

layout(std140) uniform ShaftBlock { ShaftData shaft_data; };

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;
layout(r32ui) uniform uimage2D occlusion_mask;
layout(r32ui) uniform uimage2DArray candidates;  // layer 0 the first node, layer 1 the end

const uint all_hidden = 0xffffffffu;

// Points behind the facet's plane are hidden by the receiver itself, whatever stands around it.
uint hidden_by_receiver(vec3 place, vec3 normal) {
  vec3 from = shaft_data.box_low.w * place;
  uint mask = 0u;
#define BEHIND(i) mask |= dot(normal, light_points[i].xyz - from) <= 0.0 ? 1u << (i) : 0u;
  ALL_POINTS(BEHIND)
#undef BEHIND
  return mask;
}

uint hidden_by(TrianglePlanes t) {
  uint mask = 0u;
#define HIDDEN(i)                                                                       \
  {                                                                                     \
    vec3 p = light_points[i].xyz;                                                  \
    float inside = min(min(at(t.edges[0], p), at(t.edges[1], p)), at(t.edges[2], p));   \
    mask |= inside >= 0.0 && at(t.beyond, p) > 0.0 ? 1u << (i) : 0u;                    \
  }
  ALL_POINTS(HIDDEN)
#undef HIDDEN
  return mask;
}

#ifdef WITH_HOLES
uniform usamplerBuffer hole_triangles;  // three texels each: see intersector.cpp
uniform samplerBuffer hole_alphas;      // alpha of textures, row after row

float alpha_at(uint first, ivec2 size, ivec2 texel) {
  ivec2 wrapped = texel - size * ivec2(floor(vec2(texel) / vec2(size)));
  return texelFetch(hole_alphas, int(first) + wrapped.y * size.x + wrapped.x).r;
}

// Takes away from `mask` the points that are seen through a hole: where alpha, filtered bilinearly at
// full resolution, is below the cutoff.
uint without_holes(TrianglePlanes t, uint triangle, uint mask) {
  uint hole = texelFetch(hierarchy_triangles, int(3u * triangle)).w;
  if (hole == all_hidden) return mask;
  uvec4 a = texelFetch(hole_triangles, int(3u * hole));
  uvec4 b = texelFetch(hole_triangles, int(3u * hole + 1u));
  uvec4 c = texelFetch(hole_triangles, int(3u * hole + 2u));
  mat3x2 uvs = mat3x2(uintBitsToFloat(a.xy), uintBitsToFloat(a.zw), uintBitsToFloat(b.xy));
  vec3 corner_alphas = vec3(uintBitsToFloat(b.zw), uintBitsToFloat(c.x));
  float cutoff = uintBitsToFloat(c.y);
  ivec2 size = ivec2(c.w & 0xffffu, c.w >> 16);
  uint left = mask;
  for (int i = 0; i < points_per_batch; ++i) {
    if ((left >> i & 1u) == 0u) continue;
    vec3 p = light_points[i].xyz;
    vec3 weights = vec3(at(t.edges[0], p), at(t.edges[1], p), at(t.edges[2], p));
    weights /= weights.x + weights.y + weights.z;
    vec2 texel = (uvs * weights) * vec2(size) - 0.5;
    ivec2 corner = ivec2(floor(texel));
    vec2 f = texel - vec2(corner);
    float low = mix(alpha_at(c.z, size, corner), alpha_at(c.z, size, corner + ivec2(1, 0)), f.x);
    float high = mix(alpha_at(c.z, size, corner + ivec2(0, 1)), alpha_at(c.z, size, corner + ivec2(1)), f.x);
    if (dot(corner_alphas, weights) * mix(low, high, f.y) < cutoff) mask &= ~(1u << i);
  }
  return mask;
}
#endif

void note_unfinished(uint node, bool done) {
  // Some drivers end a shader's loops in silence after 65,535 rounds: a result counts only if the walk
  // came to its end.
  if (node < work.end_node && !done) atomicAdd(unfinished_invocations, 1u);
}

#ifdef FIND_CANDIDATES
layout(std430) buffer SampleBlock { uint listed[]; };      // for each set: partly lit from its front, fully from its back
layout(std430) buffer FoundBlock { uint found[]; };  // for each set: how many of either

const uint partly_lit = 0u;
const uint fully_lit = 1u;
const uint dark = 2u;

shared uint group_count[2];
shared uint group_base[2];

// Lists the samples of a workgroup together: neighbours stay neighbours.
void list_sample(ivec2 texel, uint kind) {
  uint lane = gl_LocalInvocationIndex;
  if (lane < 2u) group_count[lane] = 0u;
  barrier();
  uint place = kind == dark ? 0u : atomicAdd(group_count[min(kind, 1u)], 1u);
  barrier();
  if (lane < 2u) group_base[lane] = atomicAdd(found[2u * work.set + lane], group_count[lane]);
  barrier();
  if (kind == dark) return;
  place += group_base[kind];
  uint capacity = uint(frame.size.x * frame.size.y / (frame.size.z * frame.size.z));
  listed[work.set * capacity + (kind == partly_lit ? place : capacity - 1u - place)] =
      uint(texel.x) | uint(texel.y) << 16;
}

// The light is hidden as a whole, whatever the batch.
const uint dark_first = 0xfffffffeu;

bool hides_the_light(int verdict, uint triangle) {
#ifdef WITH_HOLES
  if (texelFetch(hierarchy_triangles, int(3u * triangle)).w != all_hidden) return false;
#endif
  return verdict == hides_all;
}

uint find_candidates(ivec2 texel, Shaft shaft, uint kind) {
  uint first = all_hidden, end = 0u;
  if (work.first_node > 0u) {
    first = imageLoad(candidates, ivec3(texel, 0)).r;
    end = imageLoad(candidates, ivec3(texel, 1)).r;
  }
  bool is_dark = kind == dark || first == dark_first;
  uint node = work.first_node;
  while (node < work.end_node && !is_dark) {
    int found_triangle = next_leaf(shaft, node, work.end_node);
    uint triangle = uint(max(found_triangle, 0));
    int verdict = found_triangle < 0 ? hides_none : classify(shaft, planes_of(shaft, triangle));
    is_dark = hides_the_light(verdict, triangle);
    // A leaf's successor is right behind it.
    first = verdict != hides_none ? min(first, node - 1u) : first;
    end = verdict != hides_none ? node : end;
  }
  note_unfinished(node, is_dark);
  if (is_dark) first = dark_first;
  imageStore(candidates, ivec3(texel, 0), uvec4(first));
  imageStore(candidates, ivec3(texel, 1), uvec4(end));
  if (is_dark) return dark;
  return first < end ? partly_lit : kind;
}

// What the receiver's own facet says of the whole light.
uint facing(Shaft shaft, vec3 normal) {
  vec2 range = range_of(shaft, vec4(normal, -shaft.finite * dot(normal, shaft.origin)));
  return range.y < 0.0 ? dark : range.x > 0.0 ? fully_lit : partly_lit;
}
#else
#if defined(LIST_OCCLUDERS) || defined(OCCLUDERS_LISTED) || defined(SOME_OCCLUDERS_LISTED)
// Place i of a sample is [i * work.stride + its index in the list]; counts follow all places.
layout(std430) buffer OccluderBlock { uint occluders[]; };
layout(std430) buffer FoundBlock { uint found[]; };

uint occluder_slot() { return work.slot + listed_index(); }
uint occluder_count_place() { return work.occluder_limit * work.stride + occluder_slot(); }
#endif

uvec2 node_range(ivec2 texel) {
  uvec2 nodes = uvec2(work.first_node, work.end_node);
#ifdef WITH_CANDIDATES
  nodes.x = max(nodes.x, imageLoad(candidates, ivec3(texel, 0)).r);
  nodes.y = min(nodes.y, imageLoad(candidates, ivec3(texel, 1)).r);
#endif
  return nodes;
}

#ifdef LIST_OCCLUDERS
void list_occluders(ivec2 texel, Shaft shaft) {
  uvec2 nodes = node_range(texel);
  uint count = 0u;
  uint slot = occluder_slot();
  while (nodes.x < nodes.y && count <= work.occluder_limit) {
    int triangle = next_leaf(shaft, nodes.x, nodes.y);
    bool hides = triangle >= 0 && classify(shaft, planes_of(shaft, uint(max(triangle, 0)))) != hides_none;
    if (hides && count < work.occluder_limit) occluders[count * work.stride + slot] = uint(triangle);
    count += hides ? 1u : 0u;
  }
  note_unfinished(nodes.x < nodes.y ? nodes.x : work.end_node, count > work.occluder_limit);
  occluders[occluder_count_place()] = count;
  if (count > work.occluder_limit) atomicAdd(found[work.overflow_place], 1u);
}
#else
// The next triangle that may hide a point, or -1. `node` and `end` are places in the sample's list, or
// in the hierarchy.
int next_triangle(Shaft shaft, inout uint node, uint end) {
#ifdef OCCLUDERS_LISTED
  int triangle = node < end ? int(occluders[node * work.stride + occluder_slot()]) : -1;
  ++node;
  return triangle;
#else
  return next_leaf(shaft, node, end);
#endif
}

void find_mask(ivec2 texel, Shaft shaft, uint mask) {
  uvec2 nodes = node_range(texel);
#ifdef OCCLUDERS_LISTED
  nodes = uvec2(0u, occluders[occluder_count_place()]);
  if (nodes.y > work.occluder_limit) return;
#else
#ifdef SOME_OCCLUDERS_LISTED
  if (occluders[occluder_count_place()] <= work.occluder_limit) return;
#endif
  if (work.first_node > 0u) mask |= imageLoad(occlusion_mask, texel).r;
#endif
  uint node = nodes.x, end = nodes.y;
  while (node < end && mask != all_hidden) {
    // Lanes run in step: each looks for a triangle that needs all points, then all test theirs.
    TrianglePlanes planes;
    int triangle = -1;
    bool partial = false;
    while (node < end && mask != all_hidden && !partial) {
      triangle = next_triangle(shaft, node, end);
      planes = planes_of(shaft, uint(max(triangle, 0)));
      int verdict = triangle < 0 ? hides_none : classify(shaft, planes);
#ifdef WITH_HOLES
      partial = verdict != hides_none;
#else
      mask = verdict == hides_all ? all_hidden : mask;
      partial = verdict == hides_some;
#endif
    }
    uint hidden = partial ? hidden_by(planes) : 0u;
#ifdef WITH_HOLES
    hidden = without_holes(planes, uint(max(triangle, 0)), hidden);
#endif
    mask |= hidden;
  }
  // The end of this walk may be nearer than the range's.
  note_unfinished(node < end ? node : work.end_node, mask == all_hidden);
  imageStore(occlusion_mask, texel, uvec4(mask));
}
#endif
#endif

void main() {
  ivec2 texel;
  bool inside = find_sample(texel);
#ifndef FIND_CANDIDATES
  if (!inside) return;
#endif
  vec4 position = texel_of(geometry_position, texel);
  uvec4 words = texel_of(geometry_words, texel);
  vec3 normal = geometric_normal_of(position, words);
  // In the hierarchy's units, where no scene is larger than 2.
  float scale = shaft_data.whole_high.w;
  vec3 origin = scale * position.xyz;
  float reach = length(origin) + min(length(origin - scale * frame.camera_position.xyz), 2.0);
  float rounding = shaft_data.box_high.w * reach;
  bool unread = !inside || position.w == 0.0 || is_outside_light(position.xyz, shaft_data.whole_low.w);
#if defined(FIND_CANDIDATES) || defined(LIST_OCCLUDERS)
  Shaft shaft = make_shaft(origin, shaft_data.whole_low.xyz, shaft_data.whole_high.xyz, shaft_data.box_low.w, rounding);
#else
  Shaft shaft = make_shaft(origin, shaft_data.box_low.xyz, shaft_data.box_high.xyz, shaft_data.box_low.w, rounding);
#endif
#ifdef FIND_CANDIDATES
  // What the shading normal is turned from is not lit, whatever the facet sees.
  bool shaded = facing(shaft, shading_normal_of(position, words)) != dark;
  uint kind = find_candidates(texel, shaft, unread || !shaded ? dark : facing(shaft, normal));
  if (inside) imageStore(occlusion_mask, texel, uvec4(kind == fully_lit ? 0u : all_hidden));
  if (work.last != 0u) list_sample(texel, kind);
#elif defined(LIST_OCCLUDERS)
  list_occluders(texel, shaft);
#else
  uint mask = shaft_data.unused.x | hidden_by_receiver(origin, normal);
  find_mask(texel, shaft, unread ? all_hidden : mask);
#endif
}
