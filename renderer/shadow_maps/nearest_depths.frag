// Least of 2x2 finer texels, or of three a side at the border of an odd size.
uniform sampler2D finer_depths;

layout(location = 0) out float out_depth;

void main() {
  ivec2 size = textureSize(finer_depths, 0);
  ivec2 first = 2 * ivec2(gl_FragCoord.xy);
  ivec2 last = first + 1;
  if (last.x == size.x - 2) last.x = size.x - 1;
  if (last.y == size.y - 2) last.y = size.y - 1;
  last = min(last, size - 1);
  float nearest = 1.0;
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x)
      nearest = min(nearest, texelFetch(finer_depths, ivec2(x, y), 0).r);
  out_depth = nearest;
}
