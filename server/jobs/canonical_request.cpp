#include "server/jobs/canonical_request.h"

#include <cmath>
#include <utility>

#include "renderer/error.h"
#include "renderer/frame/common_parameters.h"
#include "renderer/technique.h"
#include "requests/reader.h"
#include "scenes/json_text.h"
#include "scenes/library.h"
#include "server/files/digest.h"
#include "server/jobs/drawing_version.h"
#include "server/jobs/request_scene.h"
#include "techniques/parameter_schema.h"

namespace penumbra::server {
namespace {

using nlohmann::json;

/// 1 and 1.0 are one number: one picture has one id.
json with_real_numbers(const json& value) {
  if (value.is_number_integer()) return value.get<double>();
  if (!value.is_structured()) return value;
  json copy = value;
  for (auto& entry : copy) entry = with_real_numbers(entry);
  return copy;
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
  // Cheap checks of plain values go first: nothing is loaded for a request that cannot be.
  const requests::RequestValues values = requests::read_fields(request);
  CanonicalRequest canonical;
  json& out = canonical.request;
  out = values.pictured;
  canonical.measure = values.others.at("measure");
  canonical.frames = values.others.value("frames", 0u);

  canonical.technique =
      techniques::resolve(out["technique"], techniques::values_from_json(out["parameters"]));
  out["technique"] = canonical.technique.technique->id;
  out["parameters"] = techniques::values_to_json(canonical.technique.parameters);
  find_diagnostic(*canonical.technique.technique, out["diagnostic"]);  // throws where unknown
  if (canonical.measure && out["diagnostic"] != "")
    throw bad_value("diagnostic", "a diagnostic picture has no error to measure");

  const HashedScene scene = load_request_scene(out["scene"], context);
  canonical.scene = scene.scene;
  out["scene_hash"] = scene.hash;
  out["camera"] = scene.scene->cameras.at(find_camera(*scene.scene, out["camera"])).name;
  for (const char* changes : {"lights", "cameras"}) out[changes] = without_empty(out[changes]);
  const json path = std::exchange(out["camera_path"], json::array());
  const auto changed = changed_scene(scene.scene, out);  // throws where something is wrong
  const Camera& own = changed->cameras.at(find_camera(*changed, out["camera"]));
  out["camera_path"] = scenes::camera_path_document(scenes::camera_path(own, path));
  if (!out.contains("exposure"))
    out["exposure"] = std::log2(static_cast<double>(scene.scene->exposure));
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
