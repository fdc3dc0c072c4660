#include "renderer/render.h"
#include "requests/fields.h"

namespace penumbra::requests {
namespace {

using nlohmann::json;

/// Largest integer that every JSON reader keeps exactly.
constexpr double max_seed = 9007199254740991.0;

RequestField pixels(const std::string& name, std::uint32_t default_value) {
  return {.name = name,
          .kind = FieldKind::integer,
          .meaning = "Pixels",
          .example = default_value,
          .minimum = 1,
          .maximum = RenderLimits::max_size,
          .default_value = default_value,
          .in_studies = default_value};
}

std::vector<RequestField> subject() {
  return {{.name = "scene",
           .meaning = "Built-in or imported id, sweep:OxTxL, fleet:N, or a file",
           .more = "Files are for the command line alone.",
           .example = "boxes",
           .required = true},
          {.name = "technique",
           .meaning = "Id of a technique or preset",
           .example = "shadow-map",
           .required = true},
          {.name = "parameters",
           .kind = FieldKind::parameters,
           .meaning = "Parameters of the technique",
           .more = "Those left out take their defaults.",
           .example = {{"map_size", 1024}},
           .flag = "set"},
          {.name = "lights",
           .kind = FieldKind::changes,
           .meaning = "Keys of lights that are replaced",
           .example = {{"key", {{"intensity", 2}}}},
           .flag = "light",
           .entry = "light"}};
}

std::vector<RequestField> view(const RenderRequest& defaults) {
  return {{.name = "cameras",
           .kind = FieldKind::changes,
           .meaning = "Keys of cameras that are replaced",
           .example = {{"main", {{"position", {1, 2, 3}}}}},
           .flag = "camera-set",
           .entry = "camera"},
          {.name = "camera_path",
           .kind = FieldKind::list,
           .meaning = "Cameras that are drawn in order; the last is the picture",
           .more = "Each frame has what the technique keeps from those before it. Each camera is "
                   "`camera` with the keys replaced that it has: those of a camera in scene "
                   "documents (position, target or direction, up, field_of_view, ...), but no "
                   "name. Errors name the entry, as in camera_path[3].field_of_view.",
           .example = json::array({{{"position", {1, 2, 3}}}, {{"position", {1, 2, 2.5}}}}),
           .maximum = static_cast<double>(RenderLimits::max_camera_path)},
          pixels("width", defaults.width),
          pixels("height", defaults.height),
          {.name = "camera",
           .meaning = "Name of a camera",
           .example = "main",
           .default_words = "the scene's first"}};
}

std::vector<RequestField> quality(const RenderRequest& defaults) {
  return {{.name = "supersampling",
           .kind = FieldKind::integer,
           .meaning = "Samples per pixel",
           .example = 4,
           .allowed = {RenderLimits::supersampling.begin(), RenderLimits::supersampling.end()},
           .default_value = defaults.supersampling,
           .in_studies = 4,
           .label = "Samples per pixel"},
          {.name = "light_samples",
           .kind = FieldKind::integer,
           .meaning = "Rays per pixel and light, of techniques that take many",
           .example = 256,
           .minimum = 1,
           .maximum = RenderLimits::max_light_samples,
           .default_value = defaults.light_samples,
           .in_studies = defaults.light_samples,
           .label = "Light samples"},
          {.name = "error_bound",
           .kind = FieldKind::real,
           .meaning = "Of the reference: stop once its own error is no more than this, levels of "
                      "0..255; 0 is no bound",
           .more = "Light points are drawn round by round until the root mean square of the error "
                   "of Y is no more than this, or light_samples of them are drawn.",
           .example = 0.5,
           .minimum = 0,
           .maximum = RenderLimits::max_error_bound,
           .default_value = defaults.error_bound},
          {.name = "exposure",
           .kind = FieldKind::real,
           .meaning = "EV: linear light is multiplied by 2^EV before encoding",
           .more = "It replaces the factor that the scene has; `request` of the render tells which "
                   "was taken.",
           .example = -1,
           .minimum = -RenderLimits::max_exposure,
           .maximum = RenderLimits::max_exposure,
           .default_words = "the scene's",
           .label = "Exposure, EV"},
          {.name = "seed",
           .kind = FieldKind::integer,
           .meaning = "Of everything random",
           .example = 7,
           .minimum = 0,
           .maximum = max_seed,
           .default_value = defaults.seed,
           .in_studies = defaults.seed},
          {.name = "diagnostic",
           .meaning = "Draw this diagnostic picture of the technique instead",
           .example = "depth",
           .commands = Commands::render}};
}

std::vector<RequestField> measurement() {
  return {{.name = "measure",
           .kind = FieldKind::boolean,
           .meaning = "Also measure cost and the error against the reference",
           .example = true,
           .default_value = false,
           .pictured = false,
           .commands = Commands::none},
          {.name = "frames",
           .kind = FieldKind::integer,
           .meaning = "Frames to time",
           .example = 30,
           .minimum = 1,
           .maximum = RenderLimits::max_frames,
           .default_words = std::to_string(default_frames) + ", fewer of slow ones",
           .pictured = false,
           .commands = Commands::measure}};
}

}  // namespace

std::vector<RequestField> declared_fields() {
  const RenderRequest defaults;
  std::vector<RequestField> fields;
  for (const auto& part : {subject(), view(defaults), quality(defaults), measurement()})
    fields.insert(fields.end(), part.begin(), part.end());
  return fields;
}

}  // namespace penumbra::requests
