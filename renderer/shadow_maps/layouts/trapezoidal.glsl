// One view, as of the plain map: only its clip matrix differs.
#include "renderer/shadow_maps/layouts/single.glsl"
