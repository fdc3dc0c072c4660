#include "renderer/shadow_maps/filters/summed_area.h"

#include "renderer/error.h"

namespace penumbra::shadow_maps {

std::vector<Parameter> summed_area_parameters() {
  constexpr std::int64_t largest_kernel = 129;  // texels
  std::vector<Parameter> list;
  list.push_back(
      integer("kernel", 5, {1, largest_kernel}, "Width of the filter; any width costs the same.")
          .in("texels")
          .compiled());
  list.push_back(
      boolean("adaptive", true,
              "Widen the filter, pixel by pixel, to the texels that a pixel covers, at most " +
                  std::to_string(largest_kernel) + ".")
          .compiled());
  list.push_back(
      choice("table", "int32", {"fp32", "distributed", "int32", "int32-plain", "fp64"},
             "What sums of moments are kept in. fp32: single floats. distributed: two "
             "floats a moment, one for its first eight bits. int32: fixed point that "
             "may wrap, so that only the widest filter must fit. int32-plain: fixed point of "
             "which the whole map's sum fits. fp64: doubles, where the device has them.")
          .compiled());
  return list;
}

namespace {

/// Bytes of a place of the table.
VkDeviceSize entry_bytes(const std::string& type) {
  return type == "distributed" || type == "fp64" ? 16 : 8;
}

}  // namespace

void SummedAreaTable::require(const TechniqueInput& input, Requirements& needs) {
  require_image(input, "which no table of sums is made of");
  const auto size = static_cast<std::uint64_t>(integer_of(input.parameters, "map_size"));
  needs.memory.push_back(
      {"summed-area table",
       size * size * view_count(input) * entry_bytes(choice_of(input.parameters, "table")), 0,
       "map_size"});
}

void SummedAreaTable::draw(PrepareContext& context, const DepthMap& depth) {
  const std::string& type = choice_of(context.input.parameters, "table");
  if (type == "fp64" && context.device.features.shaderFloat64 == VK_FALSE)
    throw unsupported("this device has no doubles (shaderFloat64), so no table of them", "table");
  const vulkan::ImageDescription& map = depth.image().description();
  if (!table_)
    table_ = vulkan::Buffer(context.device, context.memory, "summed-area table",
                            entry_bytes(type) * map.width * map.height * map.layers,
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  constexpr std::uint32_t lines = 8;  // of a group, as summed_area.comp has it
  const auto run = [&](const char* name, const std::string& own, const vulkan::Bindings& bindings) {
    const vulkan::Pipeline& pipeline = context.pipelines.compute(
        "renderer/shadow_maps/filters/summed_area.comp", context.declarations + own);
    context.pass(name, [&](vulkan::Commands& commands) {
      commands.bind(pipeline, bindings);
      commands.constants(static_cast<std::int32_t>(map.width));
      commands.dispatch((map.width + lines - 1) / lines, map.layers);
    });
  };
  vulkan::Bindings bindings;
  bindings.buffer("SummedAreaBlock", table_.whole());
  bindings.texture("shadow_map", depth.image(), vulkan::Sampling::nearest);
  run("sum rows", "", bindings);
  run("sum columns", "#define COLUMNS\n", bindings);
}

void SummedAreaTable::bind(vulkan::Bindings& bindings) const {
  bindings.buffer("SummedAreaBlock", table_.whole());
}

}  // namespace penumbra::shadow_maps
