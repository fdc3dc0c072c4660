#include "server/jobs/canonical_request.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "renderer/error.h"
#include "renderer/frame/common_parameters.h"
#include "renderer/technique.h"
#include "scenes/json_text.h"
#include "scenes/library.h"
#include "server/files/digest.h"
#include "server/jobs/drawing_version.h"
#include "server/jobs/request_scene.h"
#include "techniques/parameter_schema.h"

namespace penumbra::server {
namespace {

using nlohmann::json;

/// Largest integer that every JSON reader keeps exactly.
constexpr std::uint64_t max_seed = (1ull << 53) - 1;
constexpr std::size_t max_name = 4096;  // characters: scene names may be paths

std::string shown(const json& value) {
  std::string text = scenes::json_text(value);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

/// Reads what a request says, key by key; what nobody asked for is an error.
class Reader {
 public:
  explicit Reader(const json& request) : request_(request) {
    if (!request.is_object())
      throw bad_value("",
                      "a request is a JSON object, this is " + std::string(request.type_name()));
  }

  std::string text(const std::string& key, const std::string& fallback, bool required = false) {
    const json* value = find(key);
    if (!value || (value->is_null() && !required)) {
      if (required) throw bad_value(key, "\"" + key + "\" is missing");
      return fallback;
    }
    if (!value->is_string()) throw bad_value(key, key + " must be a text, not " + shown(*value));
    std::string text = value->get<std::string>();
    if (text.size() > max_name || text.find('\0') != std::string::npos)
      throw bad_value(key, key + " is too long or holds a zero character");
    if (required && text.empty()) throw bad_value(key, key + " is empty");
    return text;
  }

  std::uint64_t integer(const std::string& key, std::uint64_t fallback, std::uint64_t low,
                        std::uint64_t high) {
    const json* value = find(key);
    if (!value || value->is_null()) return fallback;
    const std::string allowed =
        key + " must be an integer from " + std::to_string(low) + " to " + std::to_string(high);
    std::uint64_t number = 0;
    if (value->is_number_unsigned()) {
      number = value->get<std::uint64_t>();
    } else if (value->is_number_integer() && value->get<std::int64_t>() >= 0) {
      number = static_cast<std::uint64_t>(value->get<std::int64_t>());
    } else if (value->is_number_float()) {
      const double real = value->get<double>();
      if (!(real >= 0.0 && real <= 0x1p53) || real != std::floor(real))
        throw bad_value(key, allowed + ", not " + shown(*value));
      number = static_cast<std::uint64_t>(real);
    } else {
      throw bad_value(key, allowed + ", not " + shown(*value));
    }
    if (number < low || number > high) throw bad_value(key, allowed + ", not " + shown(*value));
    return number;
  }

  double number(const std::string& key, double fallback, double low, double high) {
    const json* value = find(key);
    if (!value || value->is_null()) return fallback;
    const double number = value->is_number() ? value->get<double>() : low - 1.0;
    if (!(number >= low && number <= high))
      throw bad_value(key, key + " must be a number from " + json(low).dump() + " to " +
                               json(high).dump() + ", not " + shown(*value));
    return number;
  }

  bool boolean(const std::string& key, bool fallback) {
    const json* value = find(key);
    if (!value || value->is_null()) return fallback;
    if (!value->is_boolean())
      throw bad_value(key, key + " must be true or false, not " + shown(*value));
    return value->get<bool>();
  }

  json object(const std::string& key) {
    const json* value = find(key);
    if (!value || value->is_null()) return json::object();
    if (!value->is_object()) throw bad_value(key, key + " must be an object, not " + shown(*value));
    return *value;
  }

  json list(const std::string& key) {
    const json* value = find(key);
    if (!value || value->is_null()) return json::array();
    if (!value->is_array()) throw bad_value(key, key + " must be a list, not " + shown(*value));
    return *value;
  }

  void finish() const {
    for (const auto& [key, value] : request_.items()) {
      if (asked_.contains(key)) continue;
      std::string known;
      for (const std::string& name : asked_) known += (known.empty() ? "" : ", ") + name;
      throw bad_value(key, "unknown key \"" + key + "\"; a request has " + known);
    }
  }

 private:
  const json* find(const std::string& key) {
    asked_.insert(key);
    const auto found = request_.find(key);
    return found == request_.end() ? nullptr : &*found;
  }

  const json& request_;
  std::set<std::string> asked_;
};

/// 1 and 1.0 are one number: one picture has one id.
json with_real_numbers(const json& value) {
  if (value.is_number_integer()) return value.get<double>();
  if (!value.is_structured()) return value;
  json copy = value;
  for (auto& entry : copy) entry = with_real_numbers(entry);
  return copy;
}

std::uint64_t supersampling_of(Reader& reader, std::uint64_t fallback) {
  const auto& allowed = RenderLimits::supersampling;
  const std::uint64_t value =
      reader.integer("supersampling", fallback, allowed.front(), allowed.back());
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
    std::string list;
    for (const auto choice : allowed) list += (list.empty() ? "" : ", ") + std::to_string(choice);
    throw bad_value("supersampling",
                    "supersampling must be one of " + list + ", not " + std::to_string(value));
  }
  return value;
}

/// Overrides of lights or cameras without those that replace nothing.
json without_empty(json overrides) {
  for (auto entry = overrides.begin(); entry != overrides.end();) {
    if (entry->is_object() && entry->empty()) {
      entry = overrides.erase(entry);
    } else {
      ++entry;
    }
  }
  return with_real_numbers(overrides);
}

/// The scene with what a canonical request replaces. The last camera of a path is the picture's.
std::shared_ptr<const Scene> changed_scene(const std::shared_ptr<const Scene>& scene,
                                           const json& request) {
  const json& lights = request.at("lights");
  const json& cameras = request.at("cameras");
  const json& path = request.at("camera_path");
  if (lights.empty() && cameras.empty() && path.empty()) return scene;
  auto changed = std::make_shared<Scene>(
      lights.empty() ? *scene : scenes::with_light_overrides(*scene, lights));
  if (!cameras.empty()) *changed = scenes::with_camera_overrides(*changed, cameras);
  if (path.empty()) return changed;
  Camera& own = changed->cameras.at(find_camera(*changed, request.at("camera")));
  own = scenes::camera_path(own, json::array({path.back()})).front();
  return changed;
}

/// Keeps of a path what a picture without memory of earlier frames depends on.
void keep_last_camera(json& request) {
  json& path = request.at("camera_path");
  if (path.size() > 1) path = json::array({path.back()});
}

void identify(CanonicalRequest& canonical) {
  canonical.id = sha256(scenes::json_text(canonical.request)).substr(0, 32);
}

const TechniqueDescription& of_family(const std::string& family) {
  for (const TechniqueDescription& technique : techniques::all())
    if (technique.family == family) return technique;
  throw unsupported("this program has no technique of family " + family +
                    ": nothing can be measured");
}

/// The request with another technique at its defaults. Parameters common to all techniques (how
/// light is encoded) are carried over. The id is still the old one.
CanonicalRequest same_view(const CanonicalRequest& request, const TechniqueDescription& technique) {
  ParameterValues parameters;
  for (const Parameter& common : common_parameters())
    parameters[common.name] = request.technique.parameters.at(common.name);

  CanonicalRequest canonical;
  canonical.scene = request.scene;
  canonical.technique = techniques::resolve(technique.id, parameters);
  canonical.request = request.request;
  canonical.request["technique"] = technique.id;
  canonical.request["parameters"] = techniques::values_to_json(canonical.technique.parameters);
  canonical.request["diagnostic"] = "";
  keep_last_camera(canonical.request);
  return canonical;
}

}  // namespace

CanonicalRequest read_request(const json& request, const RequestContext& context) {
  const RenderRequest defaults;
  Reader reader(request);
  CanonicalRequest canonical;
  json& out = canonical.request;
  out = json::object();

  // Cheap checks of plain values go first: nothing is loaded for a request that cannot be.
  out["scene"] = reader.text("scene", "", true);
  const std::string technique = reader.text("technique", "", true);
  const json parameters = reader.object("parameters");
  out["width"] = reader.integer("width", defaults.width, 1, RenderLimits::max_size);
  out["height"] = reader.integer("height", defaults.height, 1, RenderLimits::max_size);
  const std::string camera = reader.text("camera", "");
  out["supersampling"] = supersampling_of(reader, defaults.supersampling);
  out["light_samples"] =
      reader.integer("light_samples", defaults.light_samples, 1, RenderLimits::max_light_samples);
  out["error_bound"] =
      reader.number("error_bound", defaults.error_bound, 0.0, RenderLimits::max_error_bound);
  const double exposure = reader.number("exposure", std::nan(""), -RenderLimits::max_exposure,
                                        RenderLimits::max_exposure);
  out["lights"] = without_empty(reader.object("lights"));
  out["cameras"] = without_empty(reader.object("cameras"));
  const json path = reader.list("camera_path");
  out["seed"] = reader.integer("seed", defaults.seed, 0, max_seed);
  out["diagnostic"] = reader.text("diagnostic", "");
  canonical.measure = reader.boolean("measure", false);
  canonical.frames =
      static_cast<std::uint32_t>(reader.integer("frames", 0, 1, RenderLimits::max_frames));
  reader.finish();

  canonical.technique = techniques::resolve(technique, techniques::values_from_json(parameters));
  out["technique"] = canonical.technique.technique->id;
  out["parameters"] = techniques::values_to_json(canonical.technique.parameters);
  find_diagnostic(*canonical.technique.technique, out["diagnostic"]);  // throws where unknown
  if (canonical.measure && out["diagnostic"] != "")
    throw bad_value("diagnostic", "a diagnostic picture has no error to measure");

  const HashedScene scene = load_request_scene(out["scene"], context);
  canonical.scene = scene.scene;
  out["scene_hash"] = scene.hash;
  out["camera"] = scene.scene->cameras.at(find_camera(*scene.scene, camera)).name;
  out["camera_path"] = json::array();
  const auto changed = changed_scene(scene.scene, out);  // throws where something is wrong
  const Camera& own = changed->cameras.at(find_camera(*changed, out["camera"]));
  out["camera_path"] = scenes::camera_path_document(scenes::camera_path(own, path));
  out["exposure"] =
      std::isnan(exposure) ? std::log2(static_cast<double>(scene.scene->exposure)) : exposure + 0.0;
  out["device"] = context.device;
  out["renderer"] = drawing_version();
  identify(canonical);
  return canonical;
}

CanonicalRequest reference_of(const CanonicalRequest& request, const RequestContext& context) {
  CanonicalRequest canonical = same_view(request, of_family("truth"));
  canonical.request["seed"] = RenderRequest{}.seed;
  canonical.request["device"] = context.device;
  identify(canonical);
  return canonical;
}

CanonicalRequest baseline_of(const CanonicalRequest& request) {
  CanonicalRequest canonical = same_view(request, of_family("none"));
  identify(canonical);
  return canonical;
}

RenderRequest to_render_request(const CanonicalRequest& canonical) {
  const json& from = canonical.request;
  RenderRequest request;
  request.scene = changed_scene(canonical.scene, from);
  request.camera = from.at("camera");
  const json& path = from.at("camera_path");
  if (path.size() > 1)
    request.earlier_cameras =
        scenes::camera_path(request.scene->cameras.at(find_camera(*request.scene, request.camera)),
                            json(path.begin(), path.end() - 1));
  request.technique = canonical.technique.technique;
  request.parameters = canonical.technique.parameters;
  request.width = from.at("width");
  request.height = from.at("height");
  request.supersampling = from.at("supersampling");
  request.light_samples = from.at("light_samples");
  request.error_bound = from.at("error_bound");
  request.seed = from.at("seed");
  request.exposure = from.at("exposure").get<double>();
  request.diagnostic = from.at("diagnostic");
  return request;
}

}  // namespace penumbra::server
