// Bounds of what is seen in each view, along the view's axes.
#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/texels/float_places.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140) uniform MapBlock { MapData map; };
uniform sampler2D seen_positions;
layout(std430) buffer SeenBoundsBlock { uint found[]; };  // three least, three greatest for each view
layout(push_constant) uniform ChoiceBlock { uint by_depth; } choice;

bool is_in_view(MapView view, vec3 position) {
  float depth = dot(position - frame.camera_position.xyz, frame.camera_direction.xyz);
  bool is_between = depth >= view.choice.x && depth <= view.choice.y;
  vec4 clip = view.clip_from_world * vec4(position, 1.0);
  bool is_inside = clip.w > 0.0 && all(lessThanEqual(abs(clip.xy), vec2(clip.w)));
  return mix(is_inside, is_between, choice.by_depth != 0u);
}

// Samples along a side of the square that an invocation goes through: its own minima come first, since
// atomics on one place are dear.
const int block = 8;

void main() {
  ivec2 first = block * ivec2(gl_GlobalInvocationID.xy);
  ivec2 end = min(first + block, textureSize(seen_positions, 0));
  if (any(greaterThanEqual(first, end))) return;
  uint i = gl_GlobalInvocationID.z;
  MapView view = map.views[i];
  vec3 right = normalize(view.right.xyz), up = normalize(view.up.xyz);
  vec3 low = vec3(3.0e38), high = vec3(-3.0e38);
  for (int y = first.y; y < end.y; ++y) {
    for (int x = first.x; x < end.x; ++x) {
      vec4 position = texel_of(seen_positions, ivec2(x, y));
      float reach = position.w;
      if (reach <= 0.0 || !is_in_view(view, position.xyz)) continue;
      vec3 offset = position.xyz - view.origin.xyz;
      vec3 along = vec3(dot(offset, right), dot(offset, up), dot(offset, view.forward.xyz));
      low = min(low, along - reach);
      high = max(high, along + reach);
    }
  }
  if (low.x > high.x) return;
  for (uint axis = 0u; axis < 3u; ++axis) {
    atomicMin(found[6u * i + axis], place_of(low[axis]));
    atomicMax(found[6u * i + 3u + axis], place_of(high[axis]));
  }
}
