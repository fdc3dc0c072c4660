// What a technique says it will allocate, and what happens where a device cannot hold it.
#include <gtest/gtest.h>

#include "renderer/error.h"
#include "renderer/frame/prepare_context.h"
#include "renderer/plan/memory_check.h"
#include "renderer/render.h"
#include "techniques/presets.h"
#include "techniques/registry.h"
#include "tests/conformance/scenes.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra {
namespace {

RenderRequest request_for(const std::string& technique, ParameterValues parameters = {},
                          LightKind light = LightKind::spot) {
  const techniques::Resolved resolved = techniques::resolve(technique, parameters);
  Scene scene = test::box_on_ground();
  for (Light& each : scene.lights) {
    each.kind = light;
    // From within the scene it needs views all around.
    if (light == LightKind::point) each.position = {0.9, 0.4, 0.9};
  }
  RenderRequest request;
  request.scene = std::make_shared<const Scene>(std::move(scene));
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.width = request.height = 24;
  return request;
}

ParameterValues complete(const RenderRequest& request) {
  return complete_parameters(request.technique->parameters, request.parameters);
}

std::uint64_t bytes_of(const Cost& cost, const std::string& name) {
  for (const ResourceCost& resource : cost.technique_memory)
    if (resource.name == name) return resource.bytes;
  return 0;
}

/// Every need against the ledger of what was really allocated.
void expect_needs_as_allocated(const RenderRequest& request, const std::string& what) {
  std::map<std::string, std::uint64_t> declared;
  for (const Requirements& needs :
       requirements_of(request, complete(request), instance_boxes(*request.scene)))
    for (const MemoryNeed& need : needs.memory) declared[need.name] += need.bytes;
  if (declared.empty()) return;
  const Cost cost = test::renderer().render(request).cost;
  const bool has_map = complete(request).contains("map_size");
  for (const auto& [name, bytes] : declared) {
    EXPECT_LE(bytes, bytes_of(cost, name)) << what << " says too much of " << name;
    // Drivers pad images; whole layers or maps would be more. What is no map may be known later.
    if (!has_map) continue;
    EXPECT_GE(1.1 * static_cast<double>(bytes) + 65536.0, static_cast<double>(bytes_of(cost, name)))
        << what << " says too little of " << name;
  }
  // Nothing else of the technique grows with the map.
  if (!has_map) return;
  std::uint64_t silent = 0;
  for (const ResourceCost& resource : cost.technique_memory)
    if (!declared.contains(resource.name)) silent += resource.bytes;
  EXPECT_LT(silent, 1u << 18) << what << " allocates what it does not declare";
}

TEST(Memory, that_techniques_declare_is_what_they_allocate) {
  for (const TechniqueDescription& technique : techniques::all()) {
    ParameterValues parameters;
    for (const Parameter& parameter : technique.parameters)
      if (parameter.name == "map_size") parameters = {{"map_size", std::int64_t{300}}};
    // Six faces, of a size that is no power of two.
    expect_needs_as_allocated(request_for(technique.id, parameters, LightKind::point),
                              technique.id);
  }
}

TEST(Memory, of_other_settings_is_declared_too) {
  const std::vector<std::pair<std::string, ParameterValues>> others{
      {"shadow-map", {{"bias_strategy", std::string("midpoint")}}},
      {"pcf", {{"depth_bits", std::string("16")}}},
      {"esm", {{"fallback", std::string("z-max")}}},
      {"vsm", {{"precision", std::string("fp16")}, {"mips", false}}},
      {"evsm", {{"components", std::string("2")}}},
      {"msm", {{"precision", std::string("unorm16")}}},
      {"savsm", {{"table", std::string("distributed")}}}};
  for (const auto& [technique, parameters] : others)
    expect_needs_as_allocated(request_for(technique, parameters), technique);
}

TEST(Memory, beyond_the_device_is_refused_before_anything_is_allocated) {
  const Image8 before = test::renderer().render(request_for("pcf")).picture;
  const DeviceLimits limits = test::renderer().limits();
  unsigned refused = 0;
  for (const TechniqueDescription& technique : techniques::all()) {
    const bool has_map =
        std::any_of(technique.parameters.begin(), technique.parameters.end(),
                    [](const Parameter& parameter) { return parameter.name == "map_size"; });
    if (!has_map) continue;
    const RenderRequest request =
        request_for(technique.id, {{"map_size", std::int64_t{16384}}}, LightKind::point);
    std::uint64_t bytes = 0;
    for (const Requirements& needs :
         requirements_of(request, complete(request), instance_boxes(*request.scene)))
      for (const MemoryNeed& need : needs.memory) bytes += need.bytes;
    if (bytes <= limits.light) continue;
    ++refused;
    try {
      test::renderer().render(request);
      ADD_FAILURE() << technique.id << " was drawn with " << bytes << " bytes";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, "unsupported") << technique.id;
      EXPECT_NE(std::string(error.what()).find("bytes"), std::string::npos) << error.what();
    }
  }
  // Six faces of 16384 x 16384 floats are 6.4 GB.
  EXPECT_TRUE(refused >= 9 || limits.light > (std::uint64_t{6} << 30)) << refused;
  EXPECT_TRUE(tests::same(test::renderer().render(request_for("pcf")).picture, before));
}

constexpr EmbeddedFile glutton_shader[] = {
    {"test/glutton.glsl", "float calculate_shadow(ShadowQuery query) { return 1.0; }\n"}};

/// Asks for more than it declared, in the middle of a frame.
class Glutton : public Technique {
 public:
  void require(const TechniqueInput&, Requirements& needs) override {
    needs.casters = CasterUse::none;
  }
  void prepare(PrepareContext& context) override {
    vulkan::ImageDescription description;
    description.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    description.width = description.height = 64;
    description.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    small_ = vulkan::Image(context.device, context.memory, "small", description);
    context.pass("clear", [&](vulkan::Commands& commands) {
      const VkClearColorValue black{};
      const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
      vkCmdClearColorImage(commands.handle(), small_.handle(), VK_IMAGE_LAYOUT_GENERAL, &black, 1,
                           &all);
    });
    description.width = description.height = 16384;
    description.layers = 64;
    large_ = vulkan::Image(context.device, context.memory, "large", description);
  }
  void bind(vulkan::Bindings&) const override {}

 private:
  vulkan::Image small_, large_;
};

TEST(Memory, that_is_refused_in_the_middle_of_a_frame_costs_that_picture_only) {
  const Image8 before = test::renderer().render(request_for("vsm")).picture;
  TechniqueDescription glutton;
  glutton.id = "glutton";
  glutton.family = "none";
  glutton.label = "GLT";
  glutton.title = "Asks for too much";
  glutton.source = "none: a test";
  glutton.shader = "test/glutton.glsl";
  glutton.create = [] { return std::make_unique<Glutton>(); };
  TechniqueDescription finished = techniques::finish_descriptions({glutton}).front();
  finished.files = glutton_shader;
  RenderRequest request = request_for("none");
  request.technique = &finished;
  request.parameters = {};
  try {
    test::renderer().render(request);
    ADD_FAILURE() << "an image of 256 GiB was allocated";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "unsupported") << error.what();
    EXPECT_NE(std::string(error.what()).find("large"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(tests::same(test::renderer().render(request_for("vsm")).picture, before));
}

TEST(Memory, limits_that_are_not_known_refuse_nothing) {
  Requirements needs;
  needs.memory = {{"map", std::uint64_t{1} << 40, 16384}};
  EXPECT_NO_THROW(check_memory(std::vector{needs}, {}));
  EXPECT_THROW(check_memory(std::vector{needs}, {.memory = 1u << 30}), Error);
  EXPECT_THROW(check_memory(std::vector{needs}, {.light = 1u << 30}), Error);
  EXPECT_THROW(check_memory(std::vector{needs}, {.image_extent = 8192}), Error);
  EXPECT_NO_THROW(check_memory(std::vector{needs}, {.storage_buffer = 1u << 30}));
}

TEST(Memory, that_a_device_lacks_is_refused_by_the_name_of_the_parameter_that_wants_it) {
  Requirements needs;
  needs.memory = {{"rows", 1u << 20, 0, "blur"},
                  {"map", std::uint64_t{1} << 40, 16384, "map_size"}};
  for (const DeviceLimits& limits :
       {DeviceLimits{.memory = 1u << 30}, DeviceLimits{.light = 1u << 30},
        DeviceLimits{.image_extent = 8192}}) {
    try {
      check_memory(std::vector{needs}, limits);
      ADD_FAILURE() << "a terabyte was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, "unsupported");
      EXPECT_EQ(error.field, "map_size") << error.what();
    }
  }
  try {
    check_memory(std::vector{needs}, {.storage_buffer = 1u << 10});
    ADD_FAILURE() << "a megabyte was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.field, "blur") << error.what();
  }
}

}  // namespace
}  // namespace penumbra
