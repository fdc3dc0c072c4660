#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::techniques {
namespace {

constexpr std::int64_t largest_kernel = 33;  // texels

std::vector<Parameter> pcf_parameters() {
  std::vector<Parameter> list = shadow_maps::comparing_map_parameters();
  Parameter kernel;
  kernel.name = "kernel";
  kernel.type = ParameterType::integer;
  kernel.default_value = std::int64_t{3};
  kernel.minimum = 1;
  kernel.maximum = largest_kernel;
  kernel.unit = "texels";
  kernel.meaning =
      "Width of the filter: comparisons along each side, or the disc's diameter. Even widths are "
      "centred on the nearest corner of texels.";
  kernel.variant = true;
  list.push_back(kernel);

  Parameter filter;
  filter.name = "filter";
  filter.type = ParameterType::choice;
  filter.choices = {"box", "bilinear", "hardware-bilinear", "vogel"};
  filter.default_value = std::string("bilinear");
  filter.meaning =
      "How comparisons are averaged. box: equally. bilinear: each comparison is interpolated "
      "between four texels, so that the result has no steps. hardware-bilinear: the same by the "
      "sampler. vogel: taps on a disc that is turned for every pixel.";
  filter.variant = true;
  list.push_back(filter);

  Parameter taps;
  taps.name = "taps";
  taps.type = ParameterType::integer;
  taps.default_value = std::int64_t{16};
  taps.minimum = 1;
  taps.maximum = 256;
  taps.scale = ParameterScale::logarithmic;
  taps.meaning = "Comparisons of filter vogel; the others take as many as their kernel has.";
  taps.variant = true;
  list.push_back(taps);

  Parameter adaptive;
  adaptive.name = "adaptive";
  adaptive.type = ParameterType::boolean;
  adaptive.default_value = false;
  adaptive.meaning =
      "Widen the kernel to the texels that a pixel covers, rounded up to a power of two and at "
      "most " +
      std::to_string(largest_kernel) + ", where the map is finer than the picture.";
  adaptive.variant = true;
  list.push_back(adaptive);
  return list;
}

/// Percentage-closer filtering: compares first, filters after.
class PercentageCloserFilter : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    shadow_maps::DepthMap::require(input, needs);
  }

  void prepare(PrepareContext& context) override {
    const ParameterValues& parameters = context.input.parameters;
    const bool adaptive = boolean_of(parameters, "adaptive");
    const auto kernel =
        static_cast<double>(adaptive ? largest_kernel : integer_of(parameters, "kernel"));
    // Box taps are whole texels; the others may fall between them.
    const bool whole = choice_of(parameters, "filter") == "box";
    map_.draw(context, {.kernel_radius = 0.5 * (whole ? kernel - 1.0 : kernel)});
  }

  void bind(vulkan::Bindings& bindings) const override {
    map_.bind(bindings);
    bindings.texture("shadow_map_compare", map_.image(), vulkan::Sampling::compare_less_or_equal);
  }

 private:
  shadow_maps::DepthMap map_;
};

}  // namespace

TechniqueDescription describe_pcf();
TechniqueDescription describe_pcf() {
  TechniqueDescription description;
  description.id = "pcf";
  description.label = "PCF";
  description.title = "Percentage-closer filtering";
  description.family = "map";
  description.source = "van Sambeek 2007, 2.2.4; Reeves, Salesin and Cook 1987";
  description.parameters = pcf_parameters();
  description.diagnostics = {shadow_maps::map_diagnostic(), shadow_maps::views_diagnostic()};
  description.shader = "techniques/pcf/shadow.glsl";
  description.create = [] { return std::make_unique<PercentageCloserFilter>(); };
  return description;
}

}  // namespace penumbra::techniques
