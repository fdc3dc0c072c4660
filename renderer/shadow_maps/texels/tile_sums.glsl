// What is seen of each tile.
#ifndef PENUMBRA_TILE_SUMS_GLSL
#define PENUMBRA_TILE_SUMS_GLSL
#include "renderer/shaders/shader_types.h"

layout(std140) uniform MapBlock { MapData map; };
layout(std140) uniform TileRulesBlock { TileRules rules; };
layout(std430) buffer TileSumsBlock { TileSums sums[tile_count]; };
#endif
