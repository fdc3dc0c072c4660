#include "renderer/vulkan/shader_compiler.h"

#include <glslang/MachineIndependent/iomapper.h>
#include <glslang/MachineIndependent/localintermediate.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>

namespace penumbra::vulkan {
namespace {

EShLanguage language_of(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return EShLangVertex;
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return EShLangGeometry;
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return EShLangFragment;
    default:
      return EShLangCompute;
  }
}

std::string definition_of(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return "#define VERTEX_STAGE\n";
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return "#define FRAGMENT_STAGE\n";
    default:
      return {};
  }
}

VkDescriptorType descriptor_type(const glslang::TType& type) {
  if (type.getBasicType() == glslang::EbtSampler) {
    const glslang::TSampler& sampler = type.getSampler();
    if (sampler.isBuffer())
      return sampler.isImage() ? VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER
                               : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    return sampler.isImage() ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                             : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  }
  return type.getQualifier().storage == glslang::EvqBuffer ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                                           : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
}

/// Assigns one binding per name over all stages and notes what it saw.
class NameResolver : public glslang::TIoMapResolver {
 public:
  int resolveBinding(EShLanguage, glslang::TVarEntryInfo& entry) override {
    const glslang::TType& type = entry.symbol->getType();
    if (type.getQualifier().isPushConstant()) return -1;
    if (type.getBasicType() != glslang::EbtSampler && type.getBasicType() != glslang::EbtBlock)
      return -1;
    const std::string name = entry.symbol->getAccessName().c_str();
    const auto found = std::find_if(seen.begin(), seen.end(),
                                    [&](const auto& known) { return known.name == name; });
    const auto binding = static_cast<std::uint32_t>(found - seen.begin());
    if (found == seen.end()) {
      const auto count =
          type.isArray() ? static_cast<std::uint32_t>(type.getCumulativeArraySize()) : 1u;
      seen.push_back({name, binding, descriptor_type(type), count, 0});
    }
    entry.newBinding = static_cast<int>(binding);  // glslang reads it from here
    return entry.newBinding;
  }
  bool validateBinding(EShLanguage, glslang::TVarEntryInfo&) override { return true; }
  int resolveSet(EShLanguage, glslang::TVarEntryInfo& entry) override { return entry.newSet = 0; }
  int resolveUniformLocation(EShLanguage, glslang::TVarEntryInfo&) override { return -1; }
  bool validateInOut(EShLanguage, glslang::TVarEntryInfo&) override { return true; }
  int resolveInOutLocation(EShLanguage, glslang::TVarEntryInfo&) override { return -1; }
  int resolveInOutComponent(EShLanguage, glslang::TVarEntryInfo&) override { return -1; }
  int resolveInOutIndex(EShLanguage, glslang::TVarEntryInfo&) override { return -1; }
  void notifyBinding(EShLanguage, glslang::TVarEntryInfo&) override {}
  void notifyInOut(EShLanguage, glslang::TVarEntryInfo&) override {}
  void beginNotifications(EShLanguage) override {}
  void endNotifications(EShLanguage) override {}
  void beginResolve(EShLanguage) override {}
  void endResolve(EShLanguage) override {}
  void beginCollect(EShLanguage) override {}
  void endCollect(EShLanguage) override {}
  void reserverResourceSlot(glslang::TVarEntryInfo&, TInfoSink&) override {}
  void reserverStorageSlot(glslang::TVarEntryInfo&, TInfoSink&) override {}
  void addStage(EShLanguage, glslang::TIntermediate&) override {}

  std::vector<ReflectedBinding> seen;  ///< in order of binding, which is the index
};

class LibraryIncluder : public glslang::TShader::Includer {
 public:
  explicit LibraryIncluder(const ShaderLibrary& library) : library_(library) {}
  IncludeResult* includeLocal(const char* name, const char*, std::size_t) override {
    if (!library_.contains(name)) return nullptr;
    const std::string& text = library_.text(name);
    return new IncludeResult(name, text.data(), text.size(), nullptr);
  }
  void releaseInclude(IncludeResult* result) override { delete result; }

 private:
  const ShaderLibrary& library_;
};

/// What the code of a stage touches. glslang's own notion of live symbols leaves out branches on
/// constants, which the SPIR-V still contains and drivers and layers hold against the layout.
struct StaticUse {
  std::set<std::uint32_t> bindings;
  bool push_constants = false;
};

StaticUse static_use(const std::vector<std::uint32_t>& words) {
  // Opcodes and enumerants of the SPIR-V specification, sections 3.7, 3.20 and 3.49.
  enum : std::uint32_t {
    op_function_call = 57,
    op_variable = 59,
    op_image_texel_pointer = 60,
    op_load = 61,
    op_store = 62,
    op_access_chain = 65,
    op_in_bounds_access_chain = 66,
    op_array_length = 68,
    op_decorate = 71,
    decoration_binding = 33,
    storage_push_constant = 9
  };
  constexpr std::size_t header = 5;
  std::map<std::uint32_t, std::uint32_t> binding_of;
  StaticUse use;
  const auto touch = [&](std::uint32_t id) {
    const auto found = binding_of.find(id);
    if (found != binding_of.end()) use.bindings.insert(found->second);
  };
  for (std::size_t i = header; i < words.size(); i += words[i] >> 16) {
    const std::uint32_t* word = &words[i];
    switch (word[0] & 0xffffu) {
      case op_decorate:
        if (word[2] == decoration_binding) binding_of[word[1]] = word[3];
        break;
      case op_variable:
        use.push_constants = use.push_constants || word[3] == storage_push_constant;
        break;
      case op_store:
        touch(word[1]);
        break;
      case op_load:
      case op_image_texel_pointer:
      case op_array_length:
      case op_access_chain:
      case op_in_bounds_access_chain:
        touch(word[3]);
        break;
      case op_function_call:
        for (std::uint32_t a = 4; a < word[0] >> 16; ++a) touch(word[a]);
        break;
      default:
        break;
    }
  }
  return use;
}

/// glslang wants one process-wide start.
void start_glslang() {
  static const bool started = glslang::InitializeProcess();
  if (!started) throw std::logic_error("glslang does not start");
}

}  // namespace

void ShaderLibrary::add(std::span<const EmbeddedFile> files) {
  for (const EmbeddedFile& file : files) texts_[std::string(file.path)] = std::string(file.text);
}

void ShaderLibrary::add(const std::string& path, const std::string& text) {
  texts_[path] = text;
}

const std::string& ShaderLibrary::text(const std::string& path) const {
  const auto found = texts_.find(path);
  if (found == texts_.end()) throw std::logic_error("no shader " + path);
  return found->second;
}

CompiledProgram compile(const ShaderLibrary& library, const ProgramSource& source) {
  start_glslang();
  constexpr auto messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  LibraryIncluder includer(library);
  std::vector<std::unique_ptr<glslang::TShader>> shaders;
  glslang::TProgram program;
  for (const auto& [stage, path] : source.stages) {
    auto& shader = shaders.emplace_back(std::make_unique<glslang::TShader>(language_of(stage)));
    const std::string head =
        "#version 460\n#extension GL_GOOGLE_include_directive : require\n" + definition_of(stage) +
        (source.constants_from_vertex ? "#define CONSTANTS_FROM_VERTEX\n" : "") + source.preamble +
        "\n#line 1\n";
    const char* texts[] = {head.c_str(), library.text(path).c_str()};
    const char* names[] = {"preamble", path.c_str()};
    shader->setStringsWithLengthsAndNames(texts, nullptr, names, 2);
    shader->setEnvInput(glslang::EShSourceGlsl, language_of(stage), glslang::EShClientVulkan, 130);
    shader->setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader->setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    shader->setAutoMapBindings(true);
    if (!shader->parse(GetDefaultResources(), 460, ECoreProfile, false, false, messages, includer))
      throw std::logic_error("shader " + path + " does not compile:\n" + shader->getInfoLog());
    program.addShader(shader.get());
  }
  CompiledProgram compiled;
  NameResolver resolver;
  if (!program.link(messages) || !program.mapIO(&resolver))
    throw std::logic_error(std::string("shaders do not link:\n") + program.getInfoLog());
  for (const auto& [stage, path] : source.stages) {
    glslang::SpvOptions options;
    options.disableOptimizer = true;
    options.generateDebugInfo = false;
    spv::SpvBuildLogger logger;
    auto& words = compiled.spirv[stage];
    glslang::GlslangToSpv(*program.getIntermediate(language_of(stage)), words, &logger, &options);
    if (words.empty()) throw std::logic_error("shader " + path + ": " + logger.getAllMessages());
    const StaticUse use = static_use(words);
    compiled.push_constants = compiled.push_constants || use.push_constants;
    for (const std::uint32_t binding : use.bindings)
      resolver.seen[binding].stages |= static_cast<VkShaderStageFlags>(stage);
  }
  for (const ReflectedBinding& binding : resolver.seen) {
    compiled.declared.push_back(binding.name);
    if (binding.stages != 0) compiled.bindings.push_back(binding);
  }
  return compiled;
}

}  // namespace penumbra::vulkan
