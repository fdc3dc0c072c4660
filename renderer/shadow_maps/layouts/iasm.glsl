// Tiles in one buffer: rows and columns of a square in the light's plane.
#define TEXELS_IN_BUFFER

/// Place in tiles of the square, from the corner of the first.
vec2 place_in_tiles(vec3 position) {
  return 0.5 + 0.5 * (map_view(0).clip_from_world * vec4(position, 1.0)).xy;
}

/// The tile at a place of the square; the nearest beyond its border.
ivec2 tile_at(vec2 place) { return clamp(ivec2(floor(place)), ivec2(0), ivec2(tiles_a_side - 1)); }

ViewChoice choose_views(vec3 position) {
  vec2 place = place_in_tiles(position);
  if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(float(tiles_a_side)))))
    return ViewChoice(-1, -1, 0.0);
  ivec2 tile = tile_at(place);
  return ViewChoice(tile.y * tiles_a_side + tile.x, -1, 0.0);
}
