#include "renderer/shaders/full_screen.glsl"

// Alone, since the others would count among the components that a stage may write.
out gl_PerVertex { vec4 gl_Position; };

// Passes what fragments would read from blocks, where these are declared as inputs.
#ifdef CONSTANTS_FROM_VERTEX
#include "renderer/shaders/frame.glsl"

layout(location = frame_location) flat out vec4 frame_camera_position;
layout(location = frame_location + 1) flat out vec4 frame_camera_direction;
layout(location = frame_location + 2) flat out vec4 frame_ambient;
layout(location = frame_location + 3) flat out vec4 frame_size;
layout(location = frame_location + 4) flat out vec4 frame_pixel;

void pass_frame() {
  frame_camera_position = frame.camera_position;
  frame_camera_direction = frame.camera_direction;
  frame_ambient = frame.ambient;
  frame_size = frame.size;
  frame_pixel = frame.pixel;
}

#ifdef PASSES_LIGHT
#include "renderer/shaders/light.glsl"

layout(location = light_location) flat out LightData passed_light;

void pass_light() { passed_light = light; }
#else
void pass_light() {}
#endif

#if defined(PASSES_MAP) && defined(ONE_VIEW)
#include "renderer/shaders/map.glsl"

layout(location = map_location) flat out vec4 map_texel;
layout(location = view_location) flat out MapView only_view;

void pass_map() {
  map_texel = map.texel;
  only_view = map.views[0];
}
#else
void pass_map() {}
#endif

void pass_constants() {
  pass_frame();
  pass_light();
  pass_map();
#ifdef PASS_PARAMETERS
  PASS_PARAMETERS
#endif
}
#else
void pass_constants() {}
#endif

void main() {
  pass_constants();
  gl_Position = full_screen_corner();
}
