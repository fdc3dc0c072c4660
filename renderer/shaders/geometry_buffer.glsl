// Reading and writing the geometry buffer: position (xyz world, w 0 on background, otherwise 1 to 2 for
// its lower bits) and four packed words (shading normal, geometric normal, base colour, specular and
// shininess). Normals are kept as the triangle is wound; one bit says that it is seen from behind.
#ifndef PENUMBRA_GEOMETRY_BUFFER_GLSL
#define PENUMBRA_GEOMETRY_BUFFER_GLSL

// Octahedral mapping of directions (Cigolle et al. 2014), 23 bits a component: lights that graze a
// surface by a millionth see 16 bits lean. The upper 16 of both components are a word; the lower seven,
// 14 of a vector, are where the buffer has bits to spare.
const float unit_steps = 32767.0 * 128.0;

ivec2 steps_of_direction(vec3 n) {
  n /= max(abs(n.x) + abs(n.y) + abs(n.z), 1e-30);
  vec2 p = n.z >= 0.0 ? n.xy
                      : (1.0 - abs(n.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(n.xy, vec2(0.0)));
  return ivec2(round(clamp(p, -1.0, 1.0) * unit_steps));
}
uint upper_bits(ivec2 steps) { return uint(steps.x >> 7) & 0xffffu | uint(steps.y >> 7) << 16; }
uint lower_bits(ivec2 steps) { return uint(steps.x & 127) | uint(steps.y & 127) << 7; }

vec3 unit_vector(uint upper, uint lower) {
  ivec2 steps = ivec2(int(upper << 16) >> 16, int(upper) >> 16) * 128 + ivec2(lower & 127u, lower >> 7 & 127u);
  vec2 p = vec2(steps) / unit_steps;
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0)
    n.xy = (1.0 - abs(n.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(n.xy, vec2(0.0)));
  return normalize(n);
}

// Lower bits in position.w: 14 of the geometric normal, six of the shading normal, and whether the
// triangle is turned away. The shading normal's other eight lie over the base colour.
const uint turned_away = 1u << 20;

vec3 towards_viewer(vec4 position, vec3 normal) {
  return (floatBitsToUint(position.w) & turned_away) != 0u ? -normal : normal;
}
vec3 wound_facet(vec4 position, uvec4 words) {
  return unit_vector(words.y, floatBitsToUint(position.w) & 0x3fffu);
}
vec3 geometric_normal_of(vec4 position, uvec4 words) {
  return towards_viewer(position, wound_facet(position, words));
}
// Of a surface that is bent so far that this one faces away, the facet's.
vec3 shading_normal_of(vec4 position, uvec4 words) {
  vec3 normal = unit_vector(words.x, floatBitsToUint(position.w) >> 14 & 63u | words.z >> 24 << 6);
  vec3 facet = wound_facet(position, words);
  return towards_viewer(position, dot(normal, facet) < 0.0 ? facet : normal);
}

struct Surface {
  vec3 position;          // world
  vec3 shading_normal;    // unit, towards the viewer's side
  vec3 geometric_normal;  // unit, towards the viewer's side
  vec3 base_color;        // linear
  float specular;
  float shininess;
};

const float shininess_limit = 1024.0;

// The square root spreads eight bits over dark colours as the eye does.
uint pack_color(vec3 base_color) { return packUnorm4x8(vec4(sqrt(clamp(base_color, 0.0, 1.0)), 0.0)); }
vec3 unpack_color(uint word) {
  vec3 root = unpackUnorm4x8(word).rgb;
  return root * root;
}

// What all of a triangle shares: x becomes position.w, the others are the words of the same place.
uvec4 pack_facet(vec3 facet, vec3 base_color, float specular, float shininess) {
  ivec2 geometric = steps_of_direction(facet);
  uint gloss = packUnorm2x16(vec2(specular, log2(shininess) / log2(shininess_limit)));
  return uvec4(floatBitsToUint(1.0) | lower_bits(geometric), upper_bits(geometric), pack_color(base_color), gloss);
}

// `normal` as interpolated, of any length.
void pack_surface(uvec4 facet, vec3 world, vec3 normal, bool turned, out vec4 position, out uvec4 words) {
  ivec2 shading = steps_of_direction(normal);
  uint lower = lower_bits(shading);
  words = uvec4(upper_bits(shading), facet.y, facet.z | lower >> 6 << 24, facet.w);
  position = vec4(world, uintBitsToFloat(facet.x | (lower & 63u) << 14 | (turned ? turned_away : 0u)));
}

Surface unpack_surface(vec4 position, uvec4 words) {
  Surface s;
  s.position = position.xyz;
  s.shading_normal = shading_normal_of(position, words);
  s.geometric_normal = geometric_normal_of(position, words);
  s.base_color = unpack_color(words.z);
  vec2 gloss = unpackUnorm2x16(words.w);
  s.specular = gloss.x;
  s.shininess = exp2(gloss.y * log2(shininess_limit));
  return s;
}
#endif
