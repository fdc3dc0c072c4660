// Writes, for every sample of the frame, which points of the batch are hidden: bit i for point i.
// With FIND_CANDIDATES it looks at the whole light once instead, and notes the first and last triangle
// that may hide any of it: later batches need not look elsewhere, and lit samples need not look at all.
#include "renderer/reference/intersector.glsl"
#include "renderer/shaders/faults.glsl"
#include "renderer/shaders/lighting.glsl"

layout(local_size_x = 64) in;

layout(std140) uniform LightBlock { LightData light; };
layout(std140) uniform ShaftBlock { ShaftData shaft_data; };
layout(push_constant) uniform RangeBlock { uint first_node, end_node, set; } range;

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;
layout(r32ui) uniform uimage2D occlusion_mask;
layout(r32ui) uniform uimage2DArray candidates;  // layer 0 the first node, layer 1 the end

const uint all_hidden = 0xffffffffu;

// Constant indices make the driver read a point once for all lanes: hence no loop.
#define FOUR_POINTS(f, i) f(i) f(i + 1) f(i + 2) f(i + 3)
#define ALL_POINTS(f)                                                                       \
  FOUR_POINTS(f, 0) FOUR_POINTS(f, 4) FOUR_POINTS(f, 8) FOUR_POINTS(f, 12) FOUR_POINTS(f, 16) \
  FOUR_POINTS(f, 20) FOUR_POINTS(f, 24) FOUR_POINTS(f, 28)

// Points behind the facet's plane are hidden by the receiver itself, whatever stands around it.
uint hidden_by_receiver(vec3 origin, vec3 normal) {
  float limit = shaft_data.box_low.w * dot(normal, origin);
  uint mask = 0u;
#define BEHIND(i) mask |= dot(normal, shaft_data.points[i].xyz) <= limit ? 1u << (i) : 0u;
  ALL_POINTS(BEHIND)
#undef BEHIND
  return mask;
}

uint hidden_by(TrianglePlanes t) {
  uint mask = 0u;
#define HIDDEN(i)                                                                       \
  {                                                                                     \
    vec3 p = shaft_data.points[i].xyz;                                                  \
    float inside = min(min(at(t.edges[0], p), at(t.edges[1], p)), at(t.edges[2], p));   \
    mask |= inside >= 0.0 && at(t.beyond, p) > 0.0 ? 1u << (i) : 0u;                    \
  }
  ALL_POINTS(HIDDEN)
#undef HIDDEN
  return mask;
}

// No light comes here from any point of the batch, nor from the centre: the answer would not be read.
bool outside_light(vec3 x) {
  if (int(light.position.w) == light_kind_directional) return false;
  vec3 offset = x - light.position.xyz;
  float radius = shaft_data.whole_low.w;
  if (light.direction.w > 0.0 && length(offset) - radius > light.direction.w) return true;
  if (int(light.position.w) != light_kind_spot) return false;
  // Distance to the cone's mantle around the centre; a point's own cone is moved by radius at most.
  float along = dot(offset, light.direction.xyz);
  float across = sqrt(max(dot(offset, offset) - along * along, 0.0));
  float sine = sqrt(max(1.0 - light.cone.y * light.cone.y, 0.0));
  return across * light.cone.y - along * sine > radius + 1e-4 * (length(offset) + radius);
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
    vec3 p = shaft_data.points[i].xyz;
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
  // Some drivers end a shader's loops in silence after 65,535 rounds: an answer is only one if the walk
  // came to its end.
  if (node < range.end_node && !done) atomicAdd(unfinished_invocations, 1u);
}

#ifdef FIND_CANDIDATES
void find_candidates(ivec2 texel, Shaft shaft, bool dark) {
  uint first = all_hidden, end = 0u;
  if (range.first_node > 0u) {
    first = imageLoad(candidates, ivec3(texel, 0)).r;
    end = imageLoad(candidates, ivec3(texel, 1)).r;
  }
  uint node = dark ? range.end_node : range.first_node;
  while (node < range.end_node) {
    int triangle = next_leaf(shaft, node, range.end_node);
    bool found = triangle >= 0 && classify(shaft, planes_of(shaft, uint(max(triangle, 0)))) != hides_none;
    // A leaf's successor stands right behind it.
    first = found ? min(first, node - 1u) : first;
    end = found ? node : end;
  }
  note_unfinished(node, false);
  imageStore(candidates, ivec3(texel, 0), uvec4(first));
  imageStore(candidates, ivec3(texel, 1), uvec4(end));
}
#else
void find_mask(ivec2 texel, Shaft shaft, uint mask) {
  if (range.first_node > 0u) mask |= imageLoad(occlusion_mask, texel).r;
  uint node = range.first_node, end = range.end_node;
#ifdef WITH_CANDIDATES
  node = max(node, imageLoad(candidates, ivec3(texel, 0)).r);
  end = min(end, imageLoad(candidates, ivec3(texel, 1)).r);
#endif
  while (node < end && mask != all_hidden) {
    // Lanes run in step: each looks for a triangle that needs all points, then all test theirs.
    TrianglePlanes planes;
    int triangle = -1;
    bool partial = false;
    while (node < end && mask != all_hidden && !partial) {
      triangle = next_leaf(shaft, node, end);
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
  note_unfinished(node < end ? node : range.end_node, mask == all_hidden);
  imageStore(occlusion_mask, texel, uvec4(mask));
}
#endif

void main() {
  // Blocks of 4x2 samples of one kind run in step and see nearly the same triangles.
  uint lane = gl_LocalInvocationIndex;
  ivec2 place = ivec2(lane & 3u, lane >> 2 & 1u) + ivec2(lane >> 3 & 1u, lane >> 4) * ivec2(4, 2);
  int side = int(frame.size.z);
  ivec2 pixel = ivec2(gl_WorkGroupID.xy) * 8 + place;
  ivec2 texel = pixel * side + ivec2(int(range.set) % side, int(range.set) / side);
  if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) return;

  vec4 position = texelFetch(geometry_position, texel, 0);
  vec3 normal = unpack_unit_vector(texelFetch(geometry_words, texel, 0).y);
  vec3 origin = position.xyz + shaft_data.box_high.w * normal;
  bool unread = position.w == 0.0 || outside_light(position.xyz);
#ifdef FIND_CANDIDATES
  find_candidates(texel, make_shaft(origin, shaft_data.whole_low.xyz, shaft_data.whole_high.xyz, shaft_data.box_low.w), unread);
#else
  uint mask = shaft_data.unused.x | hidden_by_receiver(origin, normal);
  find_mask(texel, make_shaft(origin, shaft_data.box_low.xyz, shaft_data.box_high.xyz, shaft_data.box_low.w),
            unread ? all_hidden : mask);
#endif
}
