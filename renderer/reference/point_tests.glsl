// Triangles against all points of a batch, one bit each.
#ifndef PENUMBRA_POINT_TESTS_GLSL
#define PENUMBRA_POINT_TESTS_GLSL
#include "renderer/reference/receiver.glsl"
#include "renderer/shaders/light_points.glsl"

// The batch's points, read before any branch: there a driver that runs lanes in step reads a constant
// once for all of them, elsewhere once for each.
vec3 points[points_per_batch];

void read_points() {
#define READ(i) points[i] = light_points[i].xyz;
  ALL_POINTS(READ)
#undef READ
}

// Points behind the facet's plane are hidden by the receiver itself, whatever stands around it.
uint hidden_by_receiver(Receiver r) {
  vec3 from = shaft_data.box_low.w * r.origin;
  uint mask = 0u;
#define BEHIND(i) mask |= dot(r.normal, points[i] - from) <= 0.0 ? 1u << (i) : 0u;
  ALL_POINTS(BEHIND)
#undef BEHIND
  return mask;
}

// Without a zero's sign: no sum that begins with it is -0, so that a sign bit tells what is below 0.
vec4 unsigned_zero(vec4 plane) {
  return vec4(plane.xyz, uintBitsToFloat(plane.w == 0.0 ? 0u : floatBitsToUint(plane.w)));
}

// Bit i for point i: where it is inside all edges and beyond the triangle. The sign bits of both are taken as
// they are; the first point's is shifted down last.
uint hidden_by(TrianglePlanes t) {
  vec4 a = unsigned_zero(t.edges[0]), b = unsigned_zero(t.edges[1]), c = unsigned_zero(t.edges[2]);
  vec4 before = unsigned_zero(-t.beyond);
  uint mask = 0u;
#define HIDDEN(i)                                                                                          \
  {                                                                                                        \
    vec3 p = points[i];                                                                                    \
    uint outside = floatBitsToUint(at(a, p)) | floatBitsToUint(at(b, p)) | floatBitsToUint(at(c, p));      \
    mask = mask >> 1 | (floatBitsToUint(at(before, p)) & ~outside & 0x80000000u);                          \
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

// Loops' rounds of a test, of those that a driver allows a walk.
#ifdef WITH_HOLES
const int rounds_of_test = points_per_batch + 1;
#else
const int rounds_of_test = 1;
#endif

// Points that a triangle hides, less those that are seen through its holes.
uint hidden_by_triangle(TrianglePlanes planes, uint triangle) {
  uint hidden = hidden_by(planes);
#ifdef WITH_HOLES
  hidden = without_holes(planes, triangle, hidden);
#endif
  return hidden;
}
#endif
