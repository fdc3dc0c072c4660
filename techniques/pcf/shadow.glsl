#include "renderer/shadow_maps/diagnostics.glsl"
#include "renderer/shadow_maps/filters/percentage_closer.glsl"
#include "renderer/shadow_maps/filters/footprint.glsl"

#ifdef variant_filter_hardware_bilinear
uniform sampler2DArrayShadow shadow_map_compare;

// The sampler compares and interpolates: one read does what mean_of_bilinear does with four. A tap has
// one depth to compare with, so the receiver's plane is followed to the nearest of its four texels.
float mean_of_hardware_bilinear(MapPoint point, int size) {
  float lit = 0.0;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      vec2 place = sampled_place(point.texel) + vec2(x, y) - 0.5 * float(size - 1);
      ivec2 first = ivec2(floor(place - 0.5));
      float depth = 1.0;
      for (int corner = 0; corner < 4; ++corner)
        depth = min(depth, receiver_depth(point, first + ivec2(corner & 1, corner >> 1)));
      lit += texture(shadow_map_compare, vec4(place / map.texel.x, float(point.view), depth));
    }
  }
  return lit / float(size * size);
}
#endif

// Kernel as wide as the pixel's footprint where that is wider: 2 to the power of the mip level that a
// filtered map would be read at (Adorjan 2013, 3.1).
int adaptive_kernel(ShadowQuery query, MapPoint point) {
  float level = ceil(log2(max(footprint_width(map_footprint(query, point)), 1.0)));
  return clamp(int(exp2(level)), parameter_kernel, parameter_kernel_maximum);
}

// Distance in texels that the filter reads from the receiver's place.
float radius_of(int kernel) {
  return 0.5 * float(parameter_filter == filter_box ? kernel - 1 : kernel);
}

float filter_view(ShadowQuery query, int view) {
  int kernel = parameter_kernel;
  MapPoint point = locate(query, view, radius_of(kernel));
  if (parameter_adaptive == 1) {
    kernel = adaptive_kernel(query, point);
    point = locate(query, view, radius_of(kernel));
  }
  if (parameter_filter == filter_box) return mean_of_box(point, kernel);
  if (parameter_filter == filter_bilinear) return mean_of_bilinear(point, kernel);
#ifdef variant_filter_hardware_bilinear
  return mean_of_hardware_bilinear(point, kernel);
#else
  return mean_of_disc(point, 0.5 * float(kernel), parameter_taps, tap_rotation(query.pixel));
#endif
}
