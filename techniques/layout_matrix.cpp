#include "techniques/layout_matrix.h"

#include <algorithm>

#include "renderer/shadow_maps/layout.h"
#include "techniques/registry.h"

namespace penumbra::techniques {

std::vector<LayoutRow> layout_matrix() {
  std::vector<LayoutRow> rows;
  for (const TechniqueDescription& technique : all()) {
    const auto parameter =
        std::find_if(technique.parameters.begin(), technique.parameters.end(),
                     [](const Parameter& declared) { return declared.name == "layout"; });
    if (parameter == technique.parameters.end()) continue;
    LayoutRow row{technique.id, {}};
    for (const shadow_maps::Layout& layout : shadow_maps::layouts()) {
      std::vector<std::string>& lights = row.lights[layout.id];
      for (const auto& [name, kind] : light_kinds())
        if (shadow_maps::serves(layout, kind)) lights.emplace_back(name);
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace penumbra::techniques
