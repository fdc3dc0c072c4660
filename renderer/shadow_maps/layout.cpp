#include "renderer/shadow_maps/layout.h"

#include <algorithm>
#include <stdexcept>

namespace penumbra::shadow_maps {

std::vector<Layout> generated_layouts();  // by the build, from layouts/*.cpp

const std::vector<Layout>& layouts() {
  static const std::vector<Layout> list = [] {
    std::vector<Layout> made = generated_layouts();
    std::sort(made.begin(), made.end(), [](const Layout& a, const Layout& b) {
      const bool a_first = a.id == default_layout;
      const bool b_first = b.id == default_layout;
      return a_first != b_first ? a_first : a.id < b.id;
    });
    return made;
  }();
  return list;
}

std::string only_directional(LightKind kind) {
  return kind == LightKind::directional ? "" : "it is for directional lights";
}

std::vector<std::string> layouts_for(LightKind kind) {
  std::vector<std::string> ids;
  for (const Layout& layout : layouts())
    if (layout.refusal(kind).empty()) ids.push_back(layout.id);
  return ids;
}

const Layout& chosen_layout(const ParameterValues& parameters) {
  const std::string& id = choice_of(parameters, "layout");
  for (const Layout& layout : layouts())
    if (layout.id == id) return layout;
  throw std::logic_error("parameter layout names none: " + id);
}

}  // namespace penumbra::shadow_maps
