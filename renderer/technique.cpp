#include "renderer/technique.h"

#include "renderer/error.h"
#include "renderer/render.h"

namespace penumbra {

TechniqueInput technique_input(const RenderRequest& request, const Bounds& scene_box,
                               const Light& light, const Camera& camera,
                               const ParameterValues& parameters) {
  const std::uint32_t side = samples_per_side(request.supersampling);
  return {*request.scene,
          scene_box,
          light,
          camera,
          parameters,
          request.width * side,
          request.height * side,
          request.light_samples,
          request.seed};
}

const Diagnostic* find_diagnostic(const TechniqueDescription& technique, const std::string& name) {
  if (name.empty()) return nullptr;
  std::string known;
  for (const Diagnostic& diagnostic : technique.diagnostics) {
    if (diagnostic.name == name) return &diagnostic;
    known += (known.empty() ? "" : ", ") + diagnostic.name;
  }
  throw bad_value("diagnostic", technique.id + " has no diagnostic picture \"" + name +
                                    "\"; it has " + (known.empty() ? "none" : known));
}

}  // namespace penumbra
