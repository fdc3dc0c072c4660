#include "renderer/reference/occlusion_mask.glsl"
