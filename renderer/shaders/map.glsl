// A map's views. Programs that know its only view when they are made (ONE_VIEW) may get it as flat inputs.
#ifndef PENUMBRA_MAP_GLSL
#define PENUMBRA_MAP_GLSL
#include "renderer/shaders/shader_types.h"

#if defined(CONSTANTS_FROM_VERTEX) && defined(PASSES_MAP) && defined(ONE_VIEW) && defined(FRAGMENT_STAGE)
layout(location = map_location) flat in vec4 map_texel;
layout(location = view_location) flat in MapView only_view;
struct MapOfOneView { vec4 texel; };
MapOfOneView map = MapOfOneView(map_texel);
MapView map_view(int view) { return only_view; }
#else
layout(std140) uniform MapBlock { MapData map; };
#define map_view(view) map.views[view]
#endif
#endif
