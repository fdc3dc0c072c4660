// Receivers thrown towards the light onto planes that cut the casters in half, and looked up in the
// silhouettes there (Coleman 2006).
struct OccluderPlaneData {
  vec4 center;  // xyz world
  vec4 normal;  // xyz unit
  vec4 right;   // xyz unit over the texture's width: 1 across it
  vec4 up;      // likewise
  vec4 low;     // box of the receivers
  vec4 high;
};
layout(std430) readonly buffer OccluderPlaneBlock {
  uvec4 occluder_plane_count;
  OccluderPlaneData occluder_planes[];
};
uniform sampler2DArray occluder_textures;

float calculate_shadow(ShadowQuery query) {
  float visible = 1.0;
  for (int i = 0; i < int(occluder_plane_count.x); ++i) {
    OccluderPlaneData plane = occluder_planes[i];
    if (any(lessThan(query.position, plane.low.xyz)) || any(greaterThan(query.position, plane.high.xyz)))
      continue;
    float approach = dot(query.to_light, plane.normal.xyz);
    if (abs(approach) < 1e-6) continue;
    float along = dot(plane.center.xyz - query.position, plane.normal.xyz) / approach;
    // Behind the receiver, or beyond the light, a plane is nothing but a false shadow.
    if (parameter_sign_test != 0 && (along <= 0.0 || along >= query.light_distance)) continue;
    vec3 offset = query.position + along * query.to_light - plane.center.xyz;
    vec2 place = 0.5 + vec2(dot(offset, plane.right.xyz), dot(offset, plane.up.xyz));
    if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(1.0)))) continue;
    visible *= 1.0 - textureLod(occluder_textures, vec3(place, float(i)), 0.0).r;
  }
  return visible;
}

// The textures side by side, black where they stop light.
vec4 draw_diagnostic_textures(ShadowQuery query, vec2 picture) {
  int side = int(ceil(sqrt(max(float(occluder_plane_count.x), 1.0))));
  vec2 place = vec2(picture.x, 1.0 - picture.y) * float(side);
  int layer = (side - 1 - int(place.y)) * side + int(place.x);
  if (layer >= int(occluder_plane_count.x)) return vec4(0.5, 0.5, 0.6, 1.0);
  return vec4(vec3(1.0 - textureLod(occluder_textures, vec3(fract(place), float(layer)), 0.0).r), 1.0);
}
