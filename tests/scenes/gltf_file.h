#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include "renderer/error.h"

namespace penumbra::scenes::test {

/// Folder that is empty at first and gone at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "penumbra-scenes-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary) << bytes;
    return path / name;
  }

  std::filesystem::path path;
};

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// A glTF document with one triangle in a binary buffer beside it, to be bent as a test needs.
struct GltfFile {
  GltfFile() {
    document = {
        {"asset", {{"version", "2.0"}}},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
        {"accessors", nlohmann::json::array()},
        {"bufferViews", nlohmann::json::array()}};
    add(bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}), 5126, 3, "VEC3");
    add(bytes_of<std::uint16_t>({0, 1, 2}), 5123, 3, "SCALAR");
  }

  /// Appends a buffer view and an accessor; its index.
  int add(const std::string& bytes, int component_type, std::size_t count, const std::string& type,
          bool normalized = false) {
    while (buffer.size() % 4 != 0) buffer += '\0';
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}});
    document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                     {"componentType", component_type},
                                     {"count", count},
                                     {"type", type}});
    if (normalized) document["accessors"].back()["normalized"] = true;
    buffer += bytes;
    return static_cast<int>(document["accessors"].size()) - 1;
  }

  nlohmann::json& primitive() { return document["meshes"][0]["primitives"][0]; }

  std::filesystem::path write(const TemporaryFolder& folder,
                              const std::string& name = "test.gltf") {
    folder.write("test.bin", buffer);
    if (!document.contains("buffers"))
      document["buffers"] = {{{"uri", "test.bin"}, {"byteLength", buffer.size()}}};
    return folder.write(name, document.dump());
  }

  nlohmann::json document;
  std::string buffer;
};

/// Message of the Error that the action must throw, after its code: "unreadable: ...".
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code + ": " + error.what();
  }
  return "no error";
}

}  // namespace penumbra::scenes::test
