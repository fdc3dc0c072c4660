// Reading and writing the geometry buffer: position (xyz world, w 0 on background, otherwise 1 to 2 for
// its lower bits) and four packed words (shading normal, geometric normal, base colour, specular and
// shininess).
#ifndef PENUMBRA_GEOMETRY_BUFFER_GLSL
#define PENUMBRA_GEOMETRY_BUFFER_GLSL

// Octahedral mapping of unit vectors (Cigolle et al. 2014), 23 bits a component: lights that graze a
// surface by a millionth see 16 bits lean. The upper 16 of both components are a word; the lower seven,
// 14 of a vector, are where the buffer has bits to spare.
const float unit_steps = 32767.0 * 128.0;

ivec2 steps_of_unit_vector(vec3 n) {
  n /= abs(n.x) + abs(n.y) + abs(n.z);
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

// Lower bits: the geometric normal's and six of the shading normal's in position.w, its other eight over
// the base colour.
vec3 shading_normal_of(vec4 position, uvec4 words) {
  return unit_vector(words.x, floatBitsToUint(position.w) >> 14 & 63u | words.z >> 24 << 6);
}
vec3 geometric_normal_of(vec4 position, uvec4 words) {
  return unit_vector(words.y, floatBitsToUint(position.w) & 0x3fffu);
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

void pack_surface(Surface s, out vec4 position, out uvec4 words) {
  ivec2 shading = steps_of_unit_vector(s.shading_normal);
  ivec2 geometric = steps_of_unit_vector(s.geometric_normal);
  uint lower = lower_bits(shading);
  // The square root spreads eight bits over dark colours as the eye does.
  uint color = packUnorm4x8(vec4(sqrt(clamp(s.base_color, 0.0, 1.0)), 0.0));
  uint gloss = packUnorm2x16(vec2(s.specular, log2(s.shininess) / log2(shininess_limit)));
  words = uvec4(upper_bits(shading), upper_bits(geometric), color | lower >> 6 << 24, gloss);
  uint one = floatBitsToUint(1.0);
  position = vec4(s.position, uintBitsToFloat(one | (lower & 63u) << 14 | lower_bits(geometric)));
}

Surface unpack_surface(vec4 position, uvec4 words) {
  Surface s;
  s.position = position.xyz;
  s.shading_normal = shading_normal_of(position, words);
  s.geometric_normal = geometric_normal_of(position, words);
  vec3 root = unpackUnorm4x8(words.z).rgb;
  s.base_color = root * root;
  vec2 gloss = unpackUnorm2x16(words.w);
  s.specular = gloss.x;
  s.shininess = exp2(gloss.y * log2(shininess_limit));
  return s;
}
#endif
