// Marks in the geometry buffer where no surface was drawn.
layout(location = 0) out vec4 out_position;
layout(location = 1) out uvec4 out_words;
#ifdef EMISSIVE
layout(location = 2) out vec4 out_emitted;
#endif

void main() {
  out_position = vec4(0.0);
  out_words = uvec4(0u);
#ifdef EMISSIVE
  out_emitted = vec4(0.0);
#endif
}
