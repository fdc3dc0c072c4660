#include "renderer/shadow_maps/layout.h"

#include <algorithm>
#include <stdexcept>

#include "renderer/error.h"
#include "renderer/shadow_maps/views/light_view.h"

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

bool serves(const Layout& layout, LightKind kind) {
  return std::find(layout.serves.begin(), layout.serves.end(), kind) != layout.serves.end();
}

void require_served(const Layout& layout, const Light& light) {
  if (serves(layout, light.kind)) return;
  std::string kinds;
  for (const LightKind kind : layout.serves)
    kinds += (kinds.empty() ? "" : " and ") + name_of(kind);
  throw unsupported("layout " + layout.id + " cannot serve light " + light.name + ": it is for " +
                        kinds + " lights",
                    "layout");
}

std::vector<std::string> layouts_for(LightKind kind) {
  std::vector<std::string> ids;
  for (const Layout& layout : layouts())
    if (serves(layout, kind)) ids.push_back(layout.id);
  return ids;
}

const Layout& chosen_layout(const ParameterValues& parameters) {
  const std::string& id = choice_of(parameters, "layout");
  for (const Layout& layout : layouts())
    if (layout.id == id) return layout;
  throw std::logic_error("parameter layout names none: " + id);
}

namespace {

bool may_warp(const Layout& layout, const TechniqueInput& input) {
  return layout.warps && layout.warps(input.light, input.parameters);
}

}  // namespace

std::string view_definitions(const TechniqueInput& input) {
  const Layout& layout = chosen_layout(input.parameters);
  std::string lines;
  if (layout.view_count(input) == 1) lines += "#define ONE_VIEW\n";
  if (!may_warp(layout, input)) lines += "#define UNWARPED\n";
  return lines;
}

void check_views(const TechniqueInput& input, const std::vector<shader::MapView>& views) {
  const Layout& layout = chosen_layout(input.parameters);
  const bool warped = std::any_of(views.begin(), views.end(), is_warped);
  if (views.size() == layout.view_count(input) && (!warped || may_warp(layout, input))) return;
  throw std::logic_error("layout " + layout.id + " fitted other views than it told of");
}

}  // namespace penumbra::shadow_maps
