// Looks at the whole light from every sample of the frame: tells apart those that all, none or part of it
// reaches, and notes for the last how many triangles may hide any of it, and where in the hierarchy these
// are. Batches of points look at those samples only, and nowhere else.
#include "renderer/reference/walk.glsl"

layout(r32ui) uniform uimage2DArray candidates;               // layer 0 the first node, layer 1 the end
layout(std430) buffer ClassBlock { uint class_counts[]; };  // samples, by set and class

const uint dark = 0xffffffffu;     // instead of a class
const uint unknown = 0xfffffffeu;  // the walk is to be resumed

// Triangles that are counted: a sample that has more is not proved dark.
const uint most_counted = (1u << most_counted_power) - 1u;

uint class_of(uint count) {
  uint power = uint(findMSB(max(count, 1u)));
  uint of_many = uint(most_occluders) + 1u + 2u * (power - most_occluders_power) + (count >> (power - 1u) & 1u);
  return count <= uint(most_occluders) ? count : of_many;
}

// The light is hidden as a whole, whatever the batch.
bool hides_the_light(int verdict, uint triangle) {
#ifdef WITH_HOLES
  if (texelFetch(hierarchy_triangles, int(3u * triangle)).w != all_hidden) return false;
#endif
  return verdict == hides_all;
}

// The class of the sample, which is written down as its mask until sort_samples.comp has read it. One that
// faces part of the light only is not fully lit.
uint find_occluders(ivec2 texel, Shaft shaft, bool is_dark, bool faces_all) {
  uint first = all_hidden, end = 0u, count = 0u;
  uint nodes = work.nodes;
  uint node = begin_walk(texel, 0u);
#ifdef RESUMED
  if (node == all_hidden) return unknown;
  first = imageLoad(candidates, ivec3(texel, 0)).r;
  end = imageLoad(candidates, ivec3(texel, 1)).r;
  count = occlusion_masks[mask_place(texel)];
#endif
  while (node < nodes && !is_dark && count < most_counted && rounds_left > 0) {
    --rounds_left;
    int found_triangle = next_leaf(shaft, node, nodes);
    uint triangle = uint(max(found_triangle, 0));
    int verdict = found_triangle < 0 ? hides_none : classify(shaft, planes_of(shaft, triangle));
    is_dark = hides_the_light(verdict, triangle);
    // A leaf's successor is right behind it.
    first = verdict != hides_none ? min(first, node - 1u) : first;
    end = verdict != hides_none ? node : end;
    count += verdict != hides_none ? 1u : 0u;
  }
  bool is_cut_short = count >= most_counted;
  bool done = is_dark || is_cut_short || node >= nodes;
  end_walk(texel, node, done);
  imageStore(candidates, ivec3(texel, 0), uvec4(first));
  imageStore(candidates, ivec3(texel, 1), uvec4(is_cut_short ? nodes : end));
  uint kind = is_dark ? dark : class_of(faces_all ? count : max(count, 1u));
  occlusion_masks[mask_place(texel)] = done ? kind : count;
  return done ? kind : unknown;
}

shared uint group_counts[sample_classes];

void count_sample(uint kind) {
  for (uint i = gl_LocalInvocationIndex; i < uint(sample_classes); i += 64u) group_counts[i] = 0u;
  barrier();
  if (kind < uint(sample_classes)) atomicAdd(group_counts[kind], 1u);
  barrier();
  for (uint i = gl_LocalInvocationIndex; i < uint(sample_classes); i += 64u)
    if (group_counts[i] > 0u) atomicAdd(class_counts[work.set * uint(sample_classes) + i], group_counts[i]);
}

const uint facing_away = 0u;
const uint facing_partly = 1u;
const uint facing_wholly = 2u;

// What a plane through the receiver says of the whole light.
uint facing(Shaft shaft, vec3 normal) {
  vec2 range = range_of(shaft, vec4(normal, -shaft.finite * dot(normal, shaft.origin)));
  return range.y < 0.0 ? facing_away : range.x > 0.0 ? facing_wholly : facing_partly;
}

void main() {
  ivec2 texel;
  bool inside = find_sample(texel);
  Receiver receiver = read_receiver(texel);
  Shaft shaft = shaft_to_light(receiver);
  // What the shading normal is turned from is not lit, whatever the facet sees.
  uint faced = facing(shaft, receiver.normal);
  bool is_dark = receiver.unlit || faced == facing_away || facing(shaft, receiver.shading_normal) == facing_away;
  uint kind = dark;
  if (inside) kind = find_occluders(texel, shaft, is_dark, faced == facing_wholly);
  count_sample(kind);
}
