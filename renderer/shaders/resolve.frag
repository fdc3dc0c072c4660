// Averages the samples of a pixel in linear light and encodes once; or, FROM_LINEAR, encodes what was
// averaged before.
#include "renderer/shaders/faults.glsl"
#include "renderer/shaders/frame.glsl"

#ifdef FROM_LINEAR
uniform sampler2D linear_picture;
#else
uniform sampler2D radiance;
#endif

layout(location = 0) out vec4 out_encoded;
#ifdef WITH_LINEAR
layout(location = 1) out vec4 out_linear;
#endif

// Some devices blend what is infinite to the greatest float, 3.4e38.
bool is_finite(vec3 sum) { return all(lessThan(abs(sum), vec3(1e37))); }

vec3 mean_color(out bool finite) {
#ifdef FROM_LINEAR
  vec3 color = texelFetch(linear_picture, ivec2(gl_FragCoord.xy), 0).rgb;
  finite = is_finite(color);
  return color;
#elif defined(ONE_SAMPLE)
  vec3 color = texelFetch(radiance, ivec2(gl_FragCoord.xy), 0).rgb;
  finite = is_finite(color);
  return frame.size.w * color;
#else
  int side = int(frame.size.z);
  ivec2 first = ivec2(gl_FragCoord.xy) * side;
  vec3 sum = vec3(0.0);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) sum += texelFetch(radiance, first + ivec2(x, y), 0).rgb;
  finite = is_finite(sum);
  return frame.size.w * sum / float(side * side);
#endif
}

void main() {
  bool finite;
  vec3 color = mean_color(finite);
#ifdef WITH_LINEAR
  out_linear = vec4(color, 1.0);
#endif
  if (!finite) atomicAdd(non_finite_pixels, 1u);
  bool encode = frame.options.x != 0u;
  color = clamp(color, 0.0, 1.0);
  // A value that is no number is shown as magenta, which no scene contains.
  out_encoded = vec4(finite ? (encode ? srgb_from_linear(color) : color) : vec3(1.0, 0.0, 1.0), 1.0);
}
