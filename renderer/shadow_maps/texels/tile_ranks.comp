// Gives tiles their sizes and ranges, as Tiles::rank does on the host.
#include "renderer/shadow_maps/texels/float_places.glsl"
#include "renderer/shadow_maps/texels/tile_sums.glsl"

layout(local_size_x = tile_count) in;

layout(std430) writeonly buffer RankedMapBlock { MapData ranked; };

shared uint sizes[tile_count];

/// As set_fitted_range has it.
void set_range(inout MapView view, float near, float far) {
  if (!(far > 0.0)) far = 1.0;
  near = clamp(near, 0.0, far);
  float margin = 1e-4 * max(far - near, 1e-3 * far);
  view.range.x = max(near - margin, 0.0);
  view.range.y = far + margin;
  view.range.z = 1.0 / (view.range.y - view.range.x);
}

void main() {
  uint tile = gl_LocalInvocationID.x;
  uint importance = sums[tile].seen.x;
  uint rank = 0u, most = 1u;
  float all = 0.0;
  for (uint other = 0u; other < uint(tile_count); ++other) {
    uint its = sums[other].seen.x;
    most = max(most, its);
    all += float(its);
    if (its > importance || (its == importance && other < tile)) ++rank;
  }
  sizes[tile] = uint(tile_sizes[rank]);
  if (rules.options.z != 0u) {
    float share = float(importance) / max(all, 1.0);
    sizes[tile] = clamp(uint(sqrt(share * float(rules.options.z))), 1u, uint(largest_tile));
  }
  barrier();
  uint first = 0u;
  for (uint before = 0u; before < tile; ++before) first += sizes[before] * sizes[before];

  MapView view = map.views[tile];
  view.texels = vec4(float(sizes[tile]), float(first), 0.0, 0.0);
  view.forward.w = 2.0 * length(view.right.xyz) / view.texels.x;
  bool seen = sums[tile].seen.z != 0u;
  view.choice = vec4(seen || rules.options.y == 0u ? 1.0 : 0.0, float(importance) / float(most), float(rank), 0.0);
  if (seen && rules.options.x != 0u)
    set_range(view, float_at(~sums[tile].seen.y) - rules.granted.x - rules.granted.y * view.forward.w,
              float_at(sums[tile].seen.z));
  view.range.w = rules.granted.z + rules.granted.w * view.range.y;
  ranked.views[tile] = view;
  if (tile == 0u) ranked.texel = map.texel;
}
