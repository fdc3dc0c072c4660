#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "renderer/scene/scene.h"

namespace penumbra::server::http {

/// Throws bad_value for anything but 1 to 64 of a-z 0-9 - _, beginning with a letter or digit.
void check_scene_id(const std::string& id);

bool has_scene(const std::filesystem::path& data, const std::string& id);

/// Checks and stores an uploaded scene as data/scenes/ID/: a glTF binary, a zip with one glTF file
/// and what it names, or a scene document; which one is told by its first bytes. The old scene of
/// that id stays where the new one cannot be read. Throws unreadable, bad_value.
std::shared_ptr<const Scene> store_scene(const std::filesystem::path& data, const std::string& id,
                                         const std::string& bytes);

/// False where there is no such scene.
bool remove_scene(const std::filesystem::path& data, const std::string& id);

/// Unpacks a zip of regular files into a folder. Throws unreadable for names that lead outside, for
/// links, archives inside, more than 1000 files, over 512 MiB, or over 200 bytes from one.
void unpack(const std::string& zip, const std::filesystem::path& folder);

}  // namespace penumbra::server::http
