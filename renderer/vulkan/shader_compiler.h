#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/embedded_file.h"
#include "renderer/vulkan/device.h"

namespace penumbra::vulkan {

/// GLSL texts by their path from the repository's root. Includes are written the same way:
/// #include "renderer/shaders/lighting.glsl".
class ShaderLibrary {
 public:
  void add(std::span<const EmbeddedFile> files);
  void add(const std::string& path, const std::string& text);
  /// Throws std::logic_error for an unknown path.
  const std::string& text(const std::string& path) const;
  bool contains(const std::string& path) const { return texts_.count(path) != 0; }

 private:
  std::map<std::string, std::string> texts_;
};

/// What a program is compiled from. `preamble` goes before every stage, after #version.
struct ProgramSource {
  std::map<VkShaderStageFlagBits, std::string> stages;  ///< stage -> path
  std::string preamble;
  /// Defines CONSTANTS_FROM_VERTEX: the fragment stage takes what is constant over a draw from flat
  /// inputs instead of blocks, and the vertex stage passes it.
  bool constants_from_vertex = false;
};

/// A descriptor that the program reads or writes, under its GLSL name: the variable's for textures
/// and images, the block's for buffers. Bindings of set 0 are assigned by name, alike in all
/// stages.
struct ReflectedBinding {
  std::string name;
  std::uint32_t binding = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  std::uint32_t count = 1;
  VkShaderStageFlags stages = 0;
};

struct CompiledProgram {
  std::map<VkShaderStageFlagBits, std::vector<std::uint32_t>> spirv;
  std::vector<ReflectedBinding> bindings;  ///< those that the code really uses
  std::vector<std::string> declared;       ///< all names, used or not
  bool push_constants = false;             ///< has a push_constant block (of at most 128 bytes)
};

/// Compiles and links GLSL 4.60 for Vulkan 1.3. Throws std::logic_error with file and line: a
/// shader that does not compile is a defect of the program, not of a request.
CompiledProgram compile(const ShaderLibrary& library, const ProgramSource& source);

}  // namespace penumbra::vulkan
