// Work that takes a device equally long whenever its clocks are the same: chains of multiplications in every
// lane, and next to no memory.
layout(local_size_x = 256) in;

layout(std430) buffer YardstickBlock { float result; } yardstick;

const int turns = 8192;

void main() {
  vec4 value = vec4(0.1, 0.2, 0.3, 0.4) + 1e-6 * float(gl_GlobalInvocationID.x);
  for (int turn = 0; turn < turns; ++turn) value = fma(value, vec4(0.999), vec4(0.0005));
  // Never so, which a compiler cannot know.
  if (value.x + value.y + value.z + value.w < 0.0) yardstick.result = value.x;
}
