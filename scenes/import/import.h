#pragma once

#include <filesystem>
#include <string>

#include "renderer/scene/scene.h"

namespace penumbra::scenes {

/// glTF 2.0, .gltf or .glb. Buffers and images are taken from the file itself or from its folder
/// and below, from nowhere else. Throws unreadable naming the element at fault, unsupported for
/// glTF 1.0. `complete` adds what a picture needs and the file lacks (complete_import, and an
/// exposure that suits its lights); without it the scene may have no camera and no light.
Scene import_gltf(const std::filesystem::path& file, bool complete = true);

/// Wavefront OBJ with the materials beside it; a missing material file is a note.
Scene import_obj(const std::filesystem::path& file, bool complete = true);

/// Whole file as bytes. Throws not_found, unreadable.
std::string read_bytes(const std::filesystem::path& file);

/// What %20 and the like mean; a + stays one.
std::string percent_decoded(const std::string& text);

/// ".glb" of "A.GLB".
std::string lower_extension(const std::filesystem::path& file);

/// The file that a reference inside another file means: percent-encoding undone, unless only a file
/// of the name as written is there. Throws unreadable naming `what` where it has a scheme, is
/// absolute, climbs with `..`, or where links lead out of the folder.
std::filesystem::path resolve_inside(const std::filesystem::path& folder, const std::string& name,
                                     const std::string& what);

/// Gives an imported scene what it lacks and says so in its notes: a camera that frames everything;
/// a key light; and, where the light is ours, a ground to receive shadows.
void complete_import(Scene& scene);

/// Name that no earlier one in the list has: "light", "light 2", ...
template <class T>
std::string unique_name(const std::vector<T>& list, const std::string& wanted) {
  std::string name = wanted;
  for (std::size_t count = 2;; ++count) {
    bool taken = false;
    for (const T& element : list) taken = taken || element.name == name;
    if (!taken) return name;
    name = wanted + " " + std::to_string(count);
  }
}

}  // namespace penumbra::scenes
