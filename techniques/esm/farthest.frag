// Greatest depth among the texels that the blur reads.
#define ENCODE
vec4 encode_depth(float depth) { return vec4(depth, 0.0, 0.0, 0.0); }
#include "renderer/shadow_maps/blurred_map.frag"
