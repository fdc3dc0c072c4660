#include "renderer/shaders/full_screen.glsl"

void main() { gl_Position = full_screen_corner(); }
