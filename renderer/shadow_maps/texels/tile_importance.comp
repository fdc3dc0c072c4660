// Adds up how much of the picture each tile matters to, and between which distances from the light
// what is seen of it lies (Alecu 2014, 3.3 and 3.5).
#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/texels/float_places.glsl"
#include "renderer/shadow_maps/texels/tile_sums.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D seen_positions;

/// In parts of 2^-s: sums of integers do not hang on their order.
uint importance_of(vec3 position) {
  float depth = (frame.clip_from_world * vec4(position, 1.0)).w;
  float near = clamp(1.0 - depth / rules.importance.z, 0.0, 1.0);
  return uint(rules.importance.x * (1.0 + rules.importance.y * near));
}

void add_distances(int tile, float low, float high) {
  atomicMax(sums[tile].seen.y, ~place_of(low));
  atomicMax(sums[tile].seen.z, place_of(high));
}

// Of neighbouring samples in one tile, which are added at once: atomics on one place are dear.
int run_tile = -1;
uint run_importance = 0u;
float run_low = 3.0e38, run_high = -3.0e38;

void begin_run(int tile) {
  if (run_importance > 0u) atomicAdd(sums[run_tile].seen.x, run_importance);
  if (run_low <= run_high) add_distances(run_tile, run_low, run_high);
  run_tile = tile;
  run_importance = 0u;
  run_low = 3.0e38;
  run_high = -3.0e38;
}

void add_sample(vec4 seen) {
  vec2 place = 0.5 + 0.5 * (map.views[0].clip_from_world * vec4(seen.xyz, 1.0)).xy;
  ivec2 own = ivec2(floor(place));
  const ivec2 last = ivec2(tiles_a_side - 1);
  bool inside = own == clamp(own, ivec2(0), last);
  if (inside) {
    int tile = own.y * tiles_a_side + own.x;
    if (tile != run_tile) begin_run(tile);
    run_importance += importance_of(seen.xyz);
  }
  if (seen.w < 0.0) return;
  float distance = dot(seen.xyz - map.views[0].origin.xyz, map.views[0].forward.xyz);
  float low = distance - seen.w, high = distance + seen.w;
  // All tiles that the surface may reach before the next sample.
  float reach = seen.w / (2.0 * length(map.views[0].right.xyz));
  ivec2 first = max(ivec2(floor(max(place - reach, vec2(-1.0)))), ivec2(0));
  ivec2 end = min(ivec2(floor(min(place + reach, vec2(float(tiles_a_side))))), last);
  if (inside && first == own && end == own) {
    run_low = min(run_low, low);
    run_high = max(run_high, high);
    return;
  }
  for (int y = first.y; y <= end.y; ++y)
    for (int x = first.x; x <= end.x; ++x) add_distances(y * tiles_a_side + x, low, high);
}

// Samples along a side of the square that an invocation goes through.
const int block = 8;

void main() {
  ivec2 first = block * ivec2(gl_GlobalInvocationID.xy);
  ivec2 end = min(first + block, textureSize(seen_positions, 0));
  for (int y = first.y; y < end.y; ++y)
    for (int x = first.x; x < end.x; ++x) {
      vec4 seen = texel_of(seen_positions, ivec2(x, y));
      if (seen.w != 0.0) add_sample(seen);
    }
  begin_run(-1);
}
