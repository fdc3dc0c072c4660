#pragma once

#include <string>
#include <vector>

#include "renderer/technique.h"

namespace penumbra::techniques {

/// Every folder of techniques/ (but template/), in order of id. The folder is the registry.
const std::vector<TechniqueDescription>& all();

/// A named set of parameter values, from the technique's presets.json.
struct Preset {
  std::string id;
  std::string technique;
  std::string label;  ///< abbreviation in reports
  std::string title;
  std::string source;  ///< whose settings these are
  ParameterValues parameters;
};

const std::vector<Preset>& presets();

/// A technique id or preset id with every parameter's value, defaults filled in.
struct Resolved {
  const TechniqueDescription* technique = nullptr;
  std::string label;
  std::string title;
  ParameterValues parameters;
};

/// Looks up a technique or preset and completes its parameters; `given` overrides the preset.
/// Throws not_found (field "technique", listing what there is) or bad_value naming the parameter.
Resolved resolve(const std::string& technique_or_preset, const ParameterValues& given = {});

}  // namespace penumbra::techniques
