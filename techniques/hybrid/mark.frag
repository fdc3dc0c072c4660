// Leaves only samples at silhouettes, whose stencil is then marked.
#include "techniques/hybrid/mask.glsl"

uniform sampler2D hybrid_mask;

void main() {
  if (!is_silhouette_mask(texelFetch(hybrid_mask, ivec2(gl_FragCoord.xy), 0).r)) discard;
}
