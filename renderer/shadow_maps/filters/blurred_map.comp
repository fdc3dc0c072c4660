// One direction of a separable filter over one view of a map: columns of what was filtered along
// rows. With ENCODE, and a technique's vec4 encode_depth(float) before it, it reads and encodes
// rows of the depth map. An invocation filters a run of neighbouring texels, so that each value is
// read and encoded once for all that it counts in. VALUE is a float or vector of as many components
// as the map has, CHANNELS their names.
//
// Without a further definition the filter takes means. FILTER_LOGARITHMS: the first component holds
// logarithms, and the result is the logarithm of the mean of what they encode. FILTER_MAXIMUM: the
// result is the greatest value.
#include "renderer/shaders/shader_types.h"
#include "renderer/shaders/texel.glsl"
#include "renderer/shadow_maps/filters/blur_weights.glsl"

layout(local_size_x = blur_lines) in;

uniform writeonly image2D filtered_map;

// Of one view. Texels beyond the border repeat it.
#ifdef ENCODE
uniform sampler2D depths;
ivec2 texel_at(int line, int place) { return ivec2(place, line); }
int places() { return textureSize(depths, 0).x; }
VALUE value_at(int line, int place) {
  return VALUE(encode_depth(texel_nearest_to(depths, texel_at(line, place)).r).CHANNELS);
}
#else
uniform sampler2D blurred_rows;
ivec2 texel_at(int line, int place) { return ivec2(line, place); }
int places() { return textureSize(blurred_rows, 0).y; }
VALUE value_at(int line, int place) {
  return VALUE(texel_nearest_to(blurred_rows, texel_at(line, place)).CHANNELS);
}
#endif

#if defined(FILTER_LOGARITHMS)
// The greatest term is kept apart: exponentials of the others then lie between 0 and 1.
struct Filtered {
  float greatest, sum, total;
};
Filtered nothing() { return Filtered(-3.4e38, 0.0, 0.0); }
void add(inout Filtered filtered, int offset, float value) {
  float top = max(filtered.greatest, value);
  filtered.sum =
      filtered.sum * exp(filtered.greatest - top) + blur_weight(offset) * exp(value - top);
  filtered.greatest = top;
  filtered.total += blur_weight(offset);
}
VALUE result(Filtered filtered) { return filtered.greatest + log(filtered.sum / filtered.total); }
#elif defined(FILTER_MAXIMUM)
struct Filtered {
  VALUE greatest;
};
Filtered nothing() { return Filtered(VALUE(-3.4e38)); }
void add(inout Filtered filtered, int offset, VALUE value) {
  filtered.greatest = max(filtered.greatest, value);
}
VALUE result(Filtered filtered) { return filtered.greatest; }
#else
// Weights are made small before they are added up, and not moved behind the sum by a compiler
// (precise): a sum of values near the format's end would leave it where their mean does not.
struct Filtered {
  VALUE sum;
  float total;
};
Filtered nothing() { return Filtered(VALUE(0.0), 0.0); }
void add(inout Filtered filtered, int offset, VALUE value) {
  const float share = 1.0 / float(2 * parameter_blur + 1);
  precise VALUE sum = filtered.sum + (share * blur_weight(offset)) * value;
  filtered.sum = sum;
  filtered.total += share * blur_weight(offset);
}
VALUE result(Filtered filtered) { return filtered.sum / filtered.total; }
#endif

// Written out for runs of 8 and 40 values, since what loops a driver unrolls is its own affair. Value v
// lies v - parameter_blur after the run's first texel; the constant conditions leave what the run reads.
#define EACH_OF_RUN(DO, v) DO(0, v) DO(1, v) DO(2, v) DO(3, v) DO(4, v) DO(5, v) DO(6, v) DO(7, v)
#define EACH_OF_EIGHT(DO, v) \
  DO((v)) DO((v) + 1) DO((v) + 2) DO((v) + 3) DO((v) + 4) DO((v) + 5) DO((v) + 6) DO((v) + 7)
#define EACH_VALUE(DO) \
  EACH_OF_EIGHT(DO, 0) \
  EACH_OF_EIGHT(DO, 8) EACH_OF_EIGHT(DO, 16) EACH_OF_EIGHT(DO, 24) EACH_OF_EIGHT(DO, 32)

#define ADD(texel, v)                                \
  if (v >= texel && v <= texel + 2 * parameter_blur) \
    add(filtered[texel], v - texel - parameter_blur, value);
#define READ(v)                                               \
  if (v < blur_run + 2 * parameter_blur) {                    \
    VALUE value = value_at(line, first + v - parameter_blur); \
    EACH_OF_RUN(ADD, v)                                       \
  }
#define CLEAR(texel, unused) filtered[texel] = nothing();
#define WRITE(texel, unused)    \
  if (first + texel < places()) \
    imageStore(filtered_map, texel_at(line, first + texel), as_texel(result(filtered[texel])));

vec4 as_texel(float value) { return vec4(value, 0.0, 0.0, 0.0); }
vec4 as_texel(vec2 value) { return vec4(value, 0.0, 0.0); }
vec4 as_texel(vec4 value) { return value; }

void main() {
  int line = int(gl_GlobalInvocationID.x);
  int first = int(gl_WorkGroupID.y) * blur_run;
  if (line >= imageSize(filtered_map).x) return;  // maps are square
  Filtered filtered[blur_run];
  EACH_OF_RUN(CLEAR, 0)
  EACH_VALUE(READ)
  EACH_OF_RUN(WRITE, 0)
}
