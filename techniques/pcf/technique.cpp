#include "renderer/shadow_maps/depth_map.h"

namespace penumbra::techniques {
namespace {

constexpr std::int64_t largest_kernel = 33;  // texels

std::vector<Parameter> pcf_parameters() {
  std::vector<Parameter> list = shadow_maps::comparing_map_parameters();
  list.push_back(integer("kernel", 3, {1, largest_kernel},
                         "Width of the filter: comparisons along each side, or the disc's "
                         "diameter. Even widths are centred on the nearest corner of texels.")
                     .in("texels")
                     .compiled());
  list.push_back(
      choice(
          "filter", "bilinear", {"box", "bilinear", "hardware-bilinear", "vogel"},
          "How comparisons are averaged. box: equally. bilinear: each comparison is interpolated "
          "between four texels, so that the result has no steps. hardware-bilinear: the same by "
          "the sampler. vogel: taps on a disc that is turned for every pixel.")
          .compiled());
  list.push_back(
      integer("taps", 16, {1, 256},
              "Comparisons of filter vogel; the others take as many as their kernel has.")
          .log()
          .compiled());
  list.push_back(boolean("adaptive", false,
                         "Widen the kernel to the texels that a pixel covers, rounded up to a "
                         "power of two and at most " +
                             std::to_string(largest_kernel) +
                             ", where the map is finer than the picture.")
                     .compiled());
  return list;
}

/// Percentage-closer filtering: compares first, filters after.
class PercentageCloserFilter : public shadow_maps::MapTechnique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    MapTechnique::require(input, needs);
    by_sampler_ = choice_of(input.parameters, "filter") == "hardware-bilinear";
    if (by_sampler_) shadow_maps::require_image(input, "which no sampler can compare with");
  }
  void bind(vulkan::Bindings& bindings) const override {
    MapTechnique::bind(bindings);
    if (by_sampler_)
      bindings.texture("shadow_map_compare", map_.image(), vulkan::Sampling::compare_less_or_equal);
  }

 protected:
  shadow_maps::MapUse map_use(const ParameterValues& parameters) const override {
    const bool adaptive = boolean_of(parameters, "adaptive");
    const auto kernel =
        static_cast<double>(adaptive ? largest_kernel : integer_of(parameters, "kernel"));
    // Box taps are whole texels; the others may fall between them.
    const bool whole = choice_of(parameters, "filter") == "box";
    return {.kernel_radius = 0.5 * (whole ? kernel - 1.0 : kernel)};
  }

 private:
  bool by_sampler_ = false;
};

}  // namespace

TechniqueDescription describe_pcf() {
  TechniqueDescription description;
  description.label = "PCF";
  description.title = "Percentage-closer filtering";
  description.family = "map";
  description.source = "van Sambeek 2007, 2.2.4; Reeves, Salesin and Cook 1987";
  description.parameters = pcf_parameters();
  description.diagnostics = shadow_maps::map_diagnostics();
  description.create = create_technique<PercentageCloserFilter>;
  return description;
}

}  // namespace penumbra::techniques
