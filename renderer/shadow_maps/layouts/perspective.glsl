// One view, as of the plain map, or six around a light: only their clip matrices differ.
#include "renderer/shadow_maps/layouts/single.glsl"
