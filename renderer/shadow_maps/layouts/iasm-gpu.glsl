// The tiles of iasm: only how they are ranked differs.
#include "renderer/shadow_maps/layouts/iasm.glsl"
