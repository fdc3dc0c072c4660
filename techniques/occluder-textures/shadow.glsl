// Receivers thrown towards the light onto planes that cut the casters in half, and looked up in the
// silhouettes there (Coleman 2006). Planes of a caster are looked at only where the way to the light
// meets the box around them.
struct OccluderPlaneData {
  vec4 center;  // xyz world, w layer of the texture
  vec4 normal;  // xyz unit, w m: shadows nothing nearer
  vec4 right;   // xyz unit over the texture's width: 1 across it
  vec4 up;      // likewise
  vec4 low;     // box of the receivers
  vec4 high;
};
struct OccluderGroupData {
  vec4 low;       // box around the planes
  vec4 high;
  uvec4 members;  // planes, or groups of a cluster: x the first, y how many
};
layout(std430) readonly buffer OccluderPlaneBlock {
  uvec4 occluder_plane_count;
  OccluderPlaneData occluder_planes[];
};
layout(std430) readonly buffer OccluderGroupBlock {
  uvec4 occluder_group_count;
  OccluderGroupData occluder_groups[];
};
layout(std430) readonly buffer OccluderClusterBlock {
  uvec4 occluder_cluster_count;
  OccluderGroupData occluder_clusters[];  // of groups near each other
};
uniform sampler2DArray occluder_textures;

float light_past(OccluderPlaneData plane, ShadowQuery query) {
  if (any(lessThan(query.position, plane.low.xyz)) || any(greaterThan(query.position, plane.high.xyz)))
    return 1.0;
  float approach = dot(query.to_light, plane.normal.xyz);
  if (abs(approach) < 1e-6) return 1.0;
  float along = dot(plane.center.xyz - query.position, plane.normal.xyz) / approach;
  // Behind the receiver, or beyond the light, a plane is nothing but a false shadow.
  float nearest = plane.normal.w / abs(approach);
  if (parameter_sign_test != 0 && (along <= nearest || along >= query.light_distance)) return 1.0;
  vec3 offset = query.position + along * query.to_light - plane.center.xyz;
  vec2 place = 0.5 + vec2(dot(offset, plane.right.xyz), dot(offset, plane.up.xyz));
  if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(1.0)))) return 1.0;
  return 1.0 - textureLod(occluder_textures, vec3(place, plane.center.w), 0.0).r;
}

// Whether the way to the light meets a box; without the sign test, the whole line.
bool meets(OccluderGroupData group, ShadowQuery query, vec3 inverse) {
  vec3 a = (group.low.xyz - query.position) * inverse;
  vec3 b = (group.high.xyz - query.position) * inverse;
  vec3 enter = min(a, b);
  vec3 leave = max(a, b);
  bool half_line = parameter_sign_test != 0;
  float first = max(max(enter.x, enter.y), max(enter.z, half_line ? 0.0 : -1e30));
  float last = min(min(leave.x, leave.y), min(leave.z, half_line ? query.light_distance : 1e30));
  return first <= last;
}

float calculate_shadow(ShadowQuery query) {
  float visible = 1.0;
  // A direction along a side of a box must not give 0 / 0.
  vec3 steps = mix(query.to_light, vec3(1e-20), lessThan(abs(query.to_light), vec3(1e-20)));
  vec3 inverse = 1.0 / steps;
  for (uint c = 0u; c < occluder_cluster_count.x; ++c) {
    OccluderGroupData cluster = occluder_clusters[c];
    if (!meets(cluster, query, inverse)) continue;
    for (uint i = 0u; i < cluster.members.y; ++i) {
      OccluderGroupData group = occluder_groups[cluster.members.x + i];
      if (!meets(group, query, inverse)) continue;
      for (uint k = 0u; k < group.members.y; ++k)
        visible *= light_past(occluder_planes[group.members.x + k], query);
    }
  }
  return visible;
}

// The textures side by side, black where they stop light.
vec4 draw_diagnostic_textures(ShadowQuery query, vec2 picture) {
  int count = textureSize(occluder_textures, 0).z;
  int side = int(ceil(sqrt(float(count))));
  vec2 place = vec2(picture.x, 1.0 - picture.y) * float(side);
  int layer = (side - 1 - int(place.y)) * side + int(place.x);
  if (layer >= count) return vec4(0.5, 0.5, 0.6, 1.0);
  return vec4(vec3(1.0 - textureLod(occluder_textures, vec3(fract(place), float(layer)), 0.0).r), 1.0);
}
