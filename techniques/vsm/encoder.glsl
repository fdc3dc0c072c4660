// The first two moments of depth.
vec4 encode_depth(float depth) { return vec4(depth, depth * depth, 0.0, 0.0); }
