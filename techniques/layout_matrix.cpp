#include "techniques/layout_matrix.h"

#include <algorithm>

#include "renderer/error.h"
#include "renderer/render.h"
#include "renderer/shadow_maps/layout.h"
#include "techniques/registry.h"

namespace penumbra::techniques {
namespace {

/// Whether a technique takes a light with this layout: asked of the technique itself, so that the
/// matrix says what a render does.
bool serves(const TechniqueDescription& technique, const std::string& layout, LightKind kind) {
  const ParameterValues parameters = resolve(technique.id, {{"layout", layout}}).parameters;
  Scene scene;
  scene.lights.emplace_back().kind = kind;
  const Camera camera;
  const TechniqueInput input{scene, {}, scene.lights.front(), camera, parameters, 1, 1, 1, 0};
  try {
    Requirements needs;
    technique.create()->require(input, needs);
    return true;
  } catch (const Error& error) {
    if (error.code != "unsupported" || error.field != "layout") throw;
    return false;
  }
}

}  // namespace

std::vector<LayoutRow> layout_matrix() {
  std::vector<LayoutRow> rows;
  for (const TechniqueDescription& technique : all()) {
    const bool has_map =
        std::any_of(technique.parameters.begin(), technique.parameters.end(),
                    [](const Parameter& declared) { return declared.name == "layout"; });
    if (!has_map) continue;
    LayoutRow row{technique.id, {}};
    for (const shadow_maps::Layout& layout : shadow_maps::layouts()) {
      std::vector<std::string>& lights = row.lights[layout.id];
      for (const auto& [name, kind] : light_kinds())
        if (serves(technique, layout.id, kind)) lights.emplace_back(name);
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace penumbra::techniques
