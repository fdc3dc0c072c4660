#include "renderer/shadow_maps/filters/blurred_map.h"

#include <algorithm>
#include <bit>

namespace penumbra::shadow_maps {

std::vector<Parameter> blur_parameters() {
  std::vector<Parameter> list;
  list.push_back(
      integer("blur", 2, {0, shader::largest_blur},
              "Radius of the filter that is run over the map; it reads 2 blur + 1 texels a side.")
          .in("texels")
          .compiled());
  list.push_back(choice("blur_filter", "gauss", {"box", "gauss"},
                        "Weights of that filter. box: equal. gauss: a bell of which two standard "
                        "deviations fit in.")
                     .compiled());
  list.push_back(
      boolean("mips", true,
              "Read means over more texels where a pixel covers more than the blur does.")
          .compiled());
  list.push_back(
      boolean(
          "anisotropic", false,
          "Read up to 16 means along the direction in which a pixel covers most, instead of one.")
          .compiled());
  return list;
}

Parameter bleeding_parameter(double default_value) {
  return real("bleeding_reduction", default_value, {0.0, 0.99},
              "Light below this becomes shadow and the rest is stretched smoothly: less bleeding, "
              "darker penumbrae. 0 leaves the bound as it is.");
}

Parameter deviation_parameter() {
  return real("minimum_deviation", 0.0001, {0.0, 1.0},
              "Depths are taken to scatter at least by this share of the map's range: hides "
              "rounding of the moments.")
      .in("of range");
}

Parameter precision_parameter(const std::string& meaning) {
  return choice("precision", "fp32", {"fp16", "fp32"}, meaning).compiled();
}

Diagnostic mip_level_diagnostic() {
  return {"mip-level", "Level that each pixel reads: 0 red, 1 yellow, 2 green, 3 and above blue."};
}

std::string encoding(const std::string& encoder) {
  return "#define ENCODE\n#include \"" + encoder + "\"\n";
}

std::string blur_definitions(VkFormat format) {
  const std::string of_float = "#define CHANNELS r\n#define VALUE float\n";
  const std::string of_vector = "#define CHANNELS rg\n#define VALUE vec2\n";
  switch (format) {
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R32_SFLOAT:
      return of_float;
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R32G32_SFLOAT:
      return of_vector;
    default:
      return "#define CHANNELS rgba\n#define VALUE vec4\n";
  }
}

void dispatch_blur(vulkan::Commands& commands, std::uint32_t size) {
  static_assert(shader::blur_run == 8 && shader::largest_blur == 16, "as blurred_map.comp counts");
  constexpr std::uint32_t lines = shader::blur_lines, run = shader::blur_run;
  commands.dispatch((size + lines - 1) / lines, (size + run - 1) / run);
}

namespace {

bool has_mips(const BlurSettings& settings, const ParameterValues& parameters) {
  return settings.filter == MapFilter::mean && boolean_of(parameters, "mips");
}

}  // namespace

void BlurredMap::require(const TechniqueInput& input, const BlurSettings& settings,
                         Requirements& needs) {
  if (!keeps_image(input.parameters)) return;
  const auto size = static_cast<std::uint32_t>(integer_of(input.parameters, "map_size"));
  const std::uint64_t bytes =
      std::uint64_t{size} * size * view_count(input) * vulkan::texel_bytes(settings.format);
  needs.memory.push_back({settings.name + " rows", bytes, size, "map_size"});
  // A chain of halves adds a third.
  const std::uint64_t chain = has_mips(settings, input.parameters) ? bytes / 3 : 0;
  needs.memory.push_back({settings.name, bytes + chain, size, "map_size"});
}

void BlurredMap::draw(PrepareContext& context, const DepthMap& depth,
                      const BlurSettings& settings) {
  if (!keeps_image(context.input.parameters)) {
    context.notes.push_back("light " + context.input.light.name + ": layout " +
                            chosen_layout(context.input.parameters).id +
                            " keeps depths in a buffer: they are filtered as they are read, "
                            "(2 blur + 2)^2 of them a pixel, and without mips");
    return;
  }
  const bool mips = has_mips(settings, context.input.parameters);
  sampling_ = settings.filter != MapFilter::mean ? vulkan::Sampling::nearest
              : mips                             ? vulkan::Sampling::linear_mipmapped
                                                 : vulkan::Sampling::linear;
  if (!image_) create(context, depth, settings, mips);
  for (std::uint32_t view = 0; view < image_.description().layers; ++view)
    blur(context, depth, settings, view);
  if (mips) context.pass("mips", [&](vulkan::Commands& commands) { reduce(commands); });
}

void BlurredMap::create(PrepareContext& context, const DepthMap& depth,
                        const BlurSettings& settings, bool mips) {
  vulkan::ImageDescription description = depth.image().description();
  description.format = settings.format;
  description.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  rows_ = vulkan::Image(context.device, context.memory, settings.name + " rows", description);
  description.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  if (mips) description.levels = static_cast<std::uint32_t>(std::bit_width(description.width));
  image_ = vulkan::Image(context.device, context.memory, settings.name, description);
}

void BlurredMap::blur(PrepareContext& context, const DepthMap& depth, const BlurSettings& settings,
                      std::uint32_t view) {
  const std::uint32_t size = image_.description().width;
  const auto run = [&](const std::string& name, const std::string& encoder,
                       const vulkan::Image& target, vulkan::Bindings bindings) {
    std::string preamble = context.declarations + blur_definitions(settings.format);
    if (!encoder.empty()) preamble += encoding(encoder);
    if (settings.filter == MapFilter::logarithmic) preamble += "#define FILTER_LOGARITHMS\n";
    if (settings.filter == MapFilter::maximum) preamble += "#define FILTER_MAXIMUM\n";
    const vulkan::Pipeline& pipeline = context.pipelines.compute(blur_program, preamble);
    bindings.storage_slice("filtered_map", target, view);
    // An encoder may read parameters that are no constants.
    vulkan::Bindings all = context.frame_bindings;
    all.add(bindings);
    context.pass(name, [&](vulkan::Commands& commands) {
      commands.bind(pipeline, all);
      dispatch_blur(commands, size);
    });
  };
  vulkan::Bindings rows;
  rows.texture_slice("depths", depth.image(), view, 0, vulkan::Sampling::nearest);
  run("encode and blur", settings.encoder, rows_, rows);
  vulkan::Bindings columns;
  columns.texture_slice("blurred_rows", rows_, view, 0, vulkan::Sampling::nearest);
  run("blur", "", image_, columns);
}

/// Every level is the mean of the one before, 2x2 texels at a time.
void BlurredMap::reduce(vulkan::Commands& commands) {
  const vulkan::ImageDescription& description = image_.description();
  const auto corner = [&](std::uint32_t level) {
    return VkOffset3D{static_cast<std::int32_t>(std::max(description.width >> level, 1u)),
                      static_cast<std::int32_t>(std::max(description.height >> level, 1u)), 1};
  };
  for (std::uint32_t level = 1; level < description.levels; ++level) {
    VkImageBlit step{};
    step.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level - 1, 0, description.layers};
    step.srcOffsets[1] = corner(level - 1);
    step.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, description.layers};
    step.dstOffsets[1] = corner(level);
    commands.barrier();
    vkCmdBlitImage(commands.handle(), image_.handle(), VK_IMAGE_LAYOUT_GENERAL, image_.handle(),
                   VK_IMAGE_LAYOUT_GENERAL, 1, &step, VK_FILTER_LINEAR);
  }
}

void BlurredMap::bind(vulkan::Bindings& bindings, const std::string& name) const {
  if (image_) bindings.texture(name, image_, sampling_);
}

}  // namespace penumbra::shadow_maps
