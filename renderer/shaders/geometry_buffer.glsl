// Reading and writing the geometry buffer: position (xyz world, w 1 on a surface, 0 on background)
// and four packed words (shading normal, geometric normal, base colour, specular and shininess).
#ifndef PENUMBRA_GEOMETRY_BUFFER_GLSL
#define PENUMBRA_GEOMETRY_BUFFER_GLSL

// Octahedral mapping of unit vectors (Cigolle et al. 2014), 16 bits a component.
uint pack_unit_vector(vec3 n) {
  n /= abs(n.x) + abs(n.y) + abs(n.z);
  vec2 p = n.z >= 0.0 ? n.xy
                      : (1.0 - abs(n.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(n.xy, vec2(0.0)));
  return packSnorm2x16(p);
}
vec3 unpack_unit_vector(uint word) {
  vec2 p = unpackSnorm2x16(word);
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0)
    n.xy = (1.0 - abs(n.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(n.xy, vec2(0.0)));
  return normalize(n);
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

uvec4 pack_surface(Surface s) {
  // The square root spreads eight bits over dark colours as the eye does.
  uint color = packUnorm4x8(vec4(sqrt(clamp(s.base_color, 0.0, 1.0)), 0.0));
  uint gloss = packUnorm2x16(vec2(s.specular, log2(s.shininess) / log2(shininess_limit)));
  return uvec4(pack_unit_vector(s.shading_normal), pack_unit_vector(s.geometric_normal), color, gloss);
}

Surface unpack_surface(vec4 position, uvec4 words) {
  Surface s;
  s.position = position.xyz;
  s.shading_normal = unpack_unit_vector(words.x);
  s.geometric_normal = unpack_unit_vector(words.y);
  vec3 root = unpackUnorm4x8(words.z).rgb;
  s.base_color = root * root;
  vec2 gloss = unpackUnorm2x16(words.w);
  s.specular = gloss.x;
  s.shininess = exp2(gloss.y * log2(shininess_limit));
  return s;
}
#endif
