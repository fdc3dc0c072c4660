// Structures and constants that C++ and GLSL share: this is their only definition. Members are
// vec4, uvec4 and mat4 only, so that std140, std430 and C++ agree on the layout.
#ifndef PENUMBRA_SHADER_TYPES_H
#define PENUMBRA_SHADER_TYPES_H
#ifdef __cplusplus
#include <glm/glm.hpp>
namespace penumbra::shader {
using glm::mat4;
using glm::uvec4;
using glm::vec4;
#define PENUMBRA_CONSTANT inline constexpr
#else
#define PENUMBRA_CONSTANT const
#endif

// Light points handled by one batch: one bit each in a mask.
PENUMBRA_CONSTANT int points_per_batch = 32;
// Independent sets that the points of a light come in, where its technique asks for them: place i
// of a batch belongs to set i % scramble_count.
PENUMBRA_CONSTANT int scramble_count = 16;
// Most samples of a pixel.
PENUMBRA_CONSTANT int max_supersampling = 16;

PENUMBRA_CONSTANT int light_kind_spot = 0;
PENUMBRA_CONSTANT int light_kind_directional = 1;
PENUMBRA_CONSTANT int light_kind_point = 2;
PENUMBRA_CONSTANT int extent_kind_none = 0;
PENUMBRA_CONSTANT int extent_kind_sphere = 1;
PENUMBRA_CONSTANT int extent_kind_disc = 2;
PENUMBRA_CONSTANT int extent_kind_rectangle = 3;

// Where a vertex stage passes what is constant over a draw (CONSTANTS_FROM_VERTEX): of the frame 5
// vectors, of the light 7, of a map with one view 15, and 4 of parameters. With gl_Position these
// are the 32 that all devices have.
PENUMBRA_CONSTANT int frame_location = 0;
PENUMBRA_CONSTANT int light_location = 5;
PENUMBRA_CONSTANT int map_location = 12;
PENUMBRA_CONSTANT int view_location = 13;
PENUMBRA_CONSTANT int parameter_location = 27;
PENUMBRA_CONSTANT int passed_parameters = 16;

/// Constants of a frame. World space is the scene's, moved by SceneFrame::origin: offsets of 1e7 m
/// cost no precision.
struct FrameData {
  mat4 clip_from_world;  // reversed depth, infinite far plane
  mat4 world_from_clip;
  vec4 camera_position;   // xyz world; w 1 for perspective, 0 for orthographic
  vec4 camera_direction;  // xyz unit, into the scene; w near plane, m
  vec4 ambient;           // rgb linear; w power of two near 1 / size of the scene, 1/m
  vec4 background_low;    // rgb linear, horizon
  vec4 background_high;   // rgb linear, zenith
  vec4 size;              // xy samples of the frame, z samples per pixel along a side, w exposure
  vec4 window;  // samples: xy of the frame's first in the whole picture, zw of all of that
  vec4 pixel;   // xyz world: from a place in view to that of the next sample to the right, at
                // unit depth where the view has perspective; w 1 for an sRGB-encoded picture
};

struct LightData {
  vec4 position;   // xyz world, w kind
  vec4 direction;  // xyz from the light into the scene, w range in m (0 unlimited)
  vec4 color;      // rgb colour times intensity, w 1 for inverse-square attenuation
  vec4 cone;  // x cosine of inner angle, y cosine of outer angle, z points in this batch, w weight
              // of a point
  vec4 extent;  // x kind, y radius or half width, z half height; m, or tangents of the angle when
                // directional
  vec4 right;   // xyz unit, along a rectangle's width; w 1 - cosine of inner angle
  vec4 up;      // xyz unit, along its height; w 1 - cosine of outer angle
};

struct MaterialData {
  vec4 base_color;  // rgb linear, a alpha
  vec4 emissive;    // rgb linear
  vec4 surface;     // x specular, y shininess, z alpha cutoff (0 for opaque), w 1 if textured
};

// Filters of maps: neighbouring texels that one invocation filters, lines of a group, and the
// greatest radius.
PENUMBRA_CONSTANT int blur_run = 8;
PENUMBRA_CONSTANT int blur_lines = 64;
PENUMBRA_CONSTANT int largest_blur = 16;

// Most views of a map: tiles, cascades, or the six faces around a point light.
PENUMBRA_CONSTANT int max_map_views = 16;

// Tiles of an irregular map: 4 x 4 of one width in metres. Texels along a side by rank of
// importance (Alecu 2014, 4.2); all of them in 32 bits take 6,860,800 bytes.
PENUMBRA_CONSTANT int tiles_a_side = 4;
PENUMBRA_CONSTANT int tile_count = 16;
PENUMBRA_CONSTANT int largest_tile = 1024;
PENUMBRA_CONSTANT int tile_sizes[tile_count] = {1024, 512, 512, 256, 128, 128, 128, 128,
                                                64,   64,  32,  32,  16,  16,  16,  16};

/// One view from the light. A point x of it lies at origin + s (forward + a right + b up) when
/// perspective, origin + s forward + a right + b up when not, with a and b from -1 to 1 over the
/// map (b downwards) and s the distance along `forward`; unless the map is warped, as `unwarp`
/// tells. From a light far away distances are floats too coarse for depth: there the origin is
/// moved along `forward` to the scene, and distances and the range are counted from where it is
/// then.
struct MapView {
  mat4 clip_from_world;
  vec4 origin;     // xyz world, w 1 for perspective
  vec4 right;      // xyz scaled by half the map's width at unit distance; w how far the origin was
                   // moved, m
  vec4 up;         // xyz scaled likewise, towards growing v
  vec4 forward;    // xyz unit, w size of a texel at unit distance (perspective) or anywhere, m
  vec4 range;      // x near, y far, m along forward; z 1 / (far - near); w bias of every depth, m
  vec4 choice;     // what the layout's GLSL chooses views by
  vec4 texels;     // x along a side; y the first one's place, where all share one buffer
  vec4 unwarp[3];  // columns, xyz each: from a place (u, v, 1) in texels to the unwarped map's,
                   // times a common factor
};

struct MapData {
  MapView views[max_map_views];
  vec4 texel;  // x texels along a view's side, y kernel radius in texels, z views, w slope scale
};

/// How tiles are ranked and given their ranges.
struct TileRules {
  vec4 importance;  // x sum for an importance of 1, y gain, z range, m
  vec4 granted;   // of comparisons: x m, y m for each m of a texel; z of depths: m, w m for each m
                  // of the range's end
  uvec4 options;  // x ranges follow what is seen, y tiles that show nothing are not drawn, z texels
                  // of all tiles where these are shared in proportion, otherwise 0
};

/// What is seen of a tile. Places of floats in the order of all floats.
struct TileSums {
  uvec4 seen;  // x importance, y complement of the least distance's place, z the greatest's; y and
               // z 0 where nothing is seen that faces the light
};

// Classes of samples, by what a look at the whole light found: 0 nothing hides any of it; up to
// most_occluders the number of triangles that may; then two for each power of two, to the one
// before which counting stops.
PENUMBRA_CONSTANT int most_occluders_power = 6;
PENUMBRA_CONSTANT int most_occluders = 1 << most_occluders_power;
PENUMBRA_CONSTANT int most_counted_power = 7;
PENUMBRA_CONSTANT int sample_classes =
    most_occluders + 1 + 2 * (most_counted_power - most_occluders_power);

// Bits that tell batches of a light's points apart.
PENUMBRA_CONSTANT int batch_bits = 32;

/// Box around the points of the batches of one bit.
struct BatchBox {
  vec4 middle;
  vec4 half_size;
};

/// Boxes that hold the light points of one batch and sample of a pixel: positions in the
/// hierarchy's units, or directions that need not be unit.
struct ShaftData {
  vec4 box_low;     // box of the batch; w 1 for positions, 0 for directions
  vec4 box_high;    // w how far receivers may lie from their surface, as a share of their places
  vec4 whole_low;   // box of the whole extent; w distance of its farthest point from the centre,
                    // m, or a tangent for directions
  vec4 whole_high;  // w units of the hierarchy in a metre
  uvec4 bits;       // x of points that the batch does not have; y place of the batch's own bit
};

#ifdef __cplusplus
}  // namespace penumbra::shader
#endif
#undef PENUMBRA_CONSTANT
#endif
