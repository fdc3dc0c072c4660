// A sample of the frame as the walks and tests of the reference see it.
#ifndef PENUMBRA_RECEIVER_GLSL
#define PENUMBRA_RECEIVER_GLSL
#include "renderer/reference/intersector.glsl"
#include "renderer/reference/mask_place.glsl"
#include "renderer/shaders/lighting.glsl"
#include "renderer/shaders/sample_list.glsl"
#include "renderer/shaders/texel.glsl"

layout(std140) uniform ShaftBlock { ShaftData shaft_data; };

uniform sampler2D geometry_position;
uniform usampler2D geometry_words;
layout(std430) buffer MaskBlock { uint occlusion_masks[]; };  // as occlusion_mask.glsl has them

const uint all_hidden = 0xffffffffu;

struct Receiver {
  vec3 origin;    // in the hierarchy's units, where no scene is larger than 2
  float rounding;  // how far it may lie from its surface, in them
  vec3 normal;    // of its facet
  vec3 shading_normal;
  bool unlit;  // nothing is there, or no light comes there
};

Receiver read_receiver(ivec2 texel) {
  vec4 position = texel_of(geometry_position, texel);
  uvec4 words = texel_of(geometry_words, texel);
  float scale = shaft_data.whole_high.w;
  Receiver r;
  r.origin = scale * position.xyz;
  float reach = length(r.origin) + min(length(r.origin - scale * frame.camera_position.xyz), 2.0);
  r.rounding = shaft_data.box_high.w * reach;
  r.normal = geometric_normal_of(position, words);
  r.shading_normal = shading_normal_of(position, words);
  r.unlit = position.w == 0.0 || is_outside_light(position.xyz, shaft_data.whole_low.w);
  return r;
}

Shaft shaft_to_light(Receiver r) {
  return make_shaft(r.origin, shaft_data.whole_low.xyz, shaft_data.whole_high.xyz, shaft_data.box_low.w, r.rounding);
}
Shaft shaft_to_batch(Receiver r) {
  return make_shaft(r.origin, shaft_data.box_low.xyz, shaft_data.box_high.xyz, shaft_data.box_low.w, r.rounding);
}
#endif
