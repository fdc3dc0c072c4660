#include "renderer/shadow_volumes/deep_count.glsl"

void main() { count_step(); }
