#pragma once

#include <map>
#include <string>

#include "experiments/stability/axes.h"
#include "experiments/stability/search.h"
#include "renderer/render.h"
#include "techniques/registry.h"

namespace penumbra::experiments::stability {

/// The whole of what a step's result depends on but device and version of the program: technique
/// with parameters, scene and picture.
std::string request_key(const techniques::Resolved& technique, const Trial& trial);

/// Draws and judges steps. Truths are kept: one serves all techniques of an axis.
class Drawing {
 public:
  explicit Drawing(const RendererOptions& options) : renderer_(options) {}

  /// Never throws but std::bad_alloc: errors are what the step tells.
  Step draw(const techniques::Resolved& technique, const Trial& trial, double value);

  const DeviceInfo& device() const { return renderer_.device(); }

 private:
  const Truth& truth_of(const Trial& trial);

  Renderer renderer_;
  std::map<std::string, Truth> truths_;
};

}  // namespace penumbra::experiments::stability
