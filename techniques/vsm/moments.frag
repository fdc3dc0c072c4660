// The first two moments of depth, blurred along rows.
#define ENCODE
vec4 encode_depth(float depth) { return vec4(depth, depth * depth, 0.0, 0.0); }
#include "renderer/shadow_maps/blurred_map.frag"
