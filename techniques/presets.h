#pragma once

#include <span>
#include <vector>

#include "renderer/embedded_file.h"
#include "techniques/registry.h"

namespace penumbra::techniques {

/// Puts folders in order of id, appends the common parameters to each, fills in the usual shader
/// and checks what nothing else does: unique ids and parameter names, sound ranges, defaults that
/// are allowed values, a factory. Throws std::logic_error naming the technique at fault: a defect
/// of the program, not of its input.
std::vector<TechniqueDescription> finish_descriptions(std::vector<TechniqueDescription> list);

/// Reads techniques/<id>/presets.json of every technique: an array of objects with "id", "label",
/// "title", "source" and "parameters". Ids are unique over techniques and presets; parameter values
/// are checked, and converted, against the declared ones. Throws unreadable naming file, preset and
/// key.
std::vector<Preset> read_presets(const std::vector<TechniqueDescription>& list,
                                 std::span<const EmbeddedFile> files);

}  // namespace penumbra::techniques
