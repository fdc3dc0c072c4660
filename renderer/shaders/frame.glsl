// What every shader of a frame may read.
#ifndef PENUMBRA_FRAME_GLSL
#define PENUMBRA_FRAME_GLSL
#include "renderer/shaders/shader_types.h"

layout(std140) uniform FrameBlock { FrameData frame; };
#if defined(CONSTANTS_FROM_VERTEX) && defined(FRAGMENT_STAGE)
layout(location = frame_location) flat in vec4 frame_camera_position;
layout(location = frame_location + 1) flat in vec4 frame_camera_direction;
layout(location = frame_location + 2) flat in vec4 frame_ambient;
layout(location = frame_location + 3) flat in vec4 frame_size;
layout(location = frame_location + 4) flat in vec4 frame_pixel;
FrameData passed_frame =
    FrameData(frame.clip_from_world, frame.world_from_clip, frame_camera_position, frame_camera_direction,
              frame_ambient, frame.background_low, frame.background_high, frame_size, frame.window, frame_pixel);
#define frame passed_frame
#endif

// A power of two near one over the scene's size, 1/m: products of lengths that are scaled by it neither
// overflow nor vanish, and lose no bit.
float inverse_size() { return frame.ambient.w; }

const float pi = 3.14159265358979;

float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

// IEC 61966-2-1.
vec3 srgb_from_linear(vec3 c) {
  return mix(1.055 * pow(max(c, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055, 12.92 * c,
             lessThanEqual(c, vec3(0.0031308)));
}
vec3 linear_from_srgb(vec3 c) {
  return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}
#endif
