#pragma once

#include <memory>
#include <string>

#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace penumbra::tests {

/// One renderer for all tests, under the validation layer: any message fails the render.
inline Renderer& renderer() {
  static Renderer shared({.device = "", .validation = true});
  return shared;
}

inline RenderRequest request(std::shared_ptr<const Scene> scene, const std::string& technique,
                             const ParameterValues& parameters = {}, std::uint32_t size = 64) {
  const techniques::Resolved resolved = techniques::resolve(technique, parameters);
  RenderRequest request;
  request.scene = std::move(scene);
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.width = request.height = size;
  request.visibility = true;
  return request;
}

inline RenderResult draw(std::shared_ptr<const Scene> scene, const std::string& technique,
                         const ParameterValues& parameters = {}, std::uint32_t size = 64) {
  return renderer().render(request(std::move(scene), technique, parameters, size));
}

inline RenderResult draw(const Scene& scene, const std::string& technique,
                         const ParameterValues& parameters = {}, std::uint32_t size = 64) {
  return draw(std::make_shared<const Scene>(scene), technique, parameters, size);
}

}  // namespace penumbra::tests
