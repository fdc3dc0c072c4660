// Reading tiles, whose texels stand in one buffer: a filter that reaches over a tile's border reads the
// neighbour there, whatever its size and range.
layout(std430) readonly buffer MapTexelBlock { uint map_texels[]; };

struct TileTexel {
  int view;
  ivec2 texel;
};

/// The texel of any tile at a place in texels of the point's. Beyond the square its border is repeated.
TileTexel find_texel(MapPoint point, ivec2 texel) {
  float size = view_size(point.view);
  if (all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(size))))
    return TileTexel(point.view, texel);
  ivec2 own = ivec2(point.view % tiles_a_side, point.view / tiles_a_side);
  vec2 place = vec2(own) + (vec2(texel) + 0.5) / size;
  ivec2 tile = tile_at(place);
  int view = tile.y * tiles_a_side + tile.x;
  int side = int(view_size(view));
  return TileTexel(view, clamp(ivec2(floor((place - vec2(tile)) * float(side))), ivec2(0), ivec2(side - 1)));
}

/// Middle of what a read of this texel finds, in texels of the point's tile.
vec2 texel_center(MapPoint point, ivec2 texel) {
  TileTexel found = find_texel(point, texel);
  if (found.view == point.view) return vec2(found.texel) + 0.5;
  ivec2 step = ivec2(found.view % tiles_a_side, found.view / tiles_a_side) -
               ivec2(point.view % tiles_a_side, point.view / tiles_a_side);
  return (vec2(step) + (vec2(found.texel) + 0.5) / view_size(found.view)) * view_size(point.view);
}

/// What a comparison with this texel grants, m: more where a neighbour's texels are wider.
float texel_grant(MapPoint point, ivec2 texel) {
  return point.grant * max(view_size(point.view) / view_size(find_texel(point, texel).view), 1.0);
}

/// Depth that the tiles hold there, in the range of the point's tile.
float fetch_depth(MapPoint point, ivec2 texel) {
  TileTexel found = find_texel(point, texel);
  vec4 texels = map.views[found.view].texels;
  uint index = uint(texels.y) + uint(found.texel.y) * uint(texels.x) + uint(found.texel.x);
  float depth = 1.0 - uintBitsToFloat(map_texels[index]);
  if (found.view == point.view) return depth;
  // What nothing was drawn into is far in every tile.
  vec4 range = map.views[found.view].range;
  return depth == 1.0 ? 1.0 : (range.x - point.range.x + depth / range.z) * point.range.z;
}
