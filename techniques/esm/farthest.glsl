// Depth itself, of which the greatest is kept.
vec4 encode_depth(float depth) { return vec4(depth, 0.0, 0.0, 0.0); }
