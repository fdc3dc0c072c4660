// Leaves only samples at silhouettes, whose stencil is then marked.
#include "renderer/shaders/texel.glsl"
#include "techniques/hybrid/mask.glsl"

uniform sampler2D hybrid_mask;

void main() {
  if (!is_silhouette_mask(texel_of(hybrid_mask, ivec2(gl_FragCoord.xy)).r)) discard;
}
