layout(location = 0) flat in vec3 linear;
layout(location = 1) flat in vec4 picture;

layout(location = 0) out vec4 out_encoded;
#ifdef WITH_LINEAR
layout(location = 1) out vec4 out_linear;
#endif

void main() {
  out_encoded = picture;
#ifdef WITH_LINEAR
  out_linear = vec4(linear, 1.0);
#endif
}
