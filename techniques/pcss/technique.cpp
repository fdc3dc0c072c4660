#include "renderer/shadow_maps/filters/nearest_depths.h"

namespace penumbra::techniques {
namespace {

Parameter taps_parameter(const char* name, std::int64_t count, const char* meaning) {
  return integer(name, count, {1, 1024}, meaning).log().compiled();
}

std::vector<Parameter> pcss_parameters() {
  std::vector<Parameter> list = shadow_maps::comparing_map_parameters();
  list.push_back(taps_parameter("search_taps", 32, "Texels searched for blockers, per pixel."));
  list.push_back(taps_parameter("taps", 64,
                                "Comparisons of the filter, per pixel where blockers were found."));
  list.push_back(choice("blocker", "average", {"average", "nearest"},
                        "Whose distance sets the penumbra's width: the mean of the blockers found, "
                        "or the one nearest to the light.")
                     .compiled());
  list.push_back(
      boolean("horizon", true,
              "Leave out what part of the light stands behind the receiver's own plane: a map of "
              "biased comparisons does not know that a body shadows itself there.")
          .compiled());
  return list;
}

/// Percentage-closer soft shadows: the filter is as wide as the penumbra ought to be.
class PercentageCloserSoftShadows : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    shadow_maps::DepthMap::require(input, needs);
    shadow_maps::NearestDepths::require(input, needs);
  }

  void prepare(PrepareContext& context) override {
    // Penumbrae reach over a view's border by their width at most; how wide they are is known only
    // in the shader. A sixteenth of the view is room for wide ones, unless the layout knows better;
    // strategy slope covers small ones.
    const bool soft = has_extent(*context.light.source);
    const auto size = static_cast<double>(integer_of(context.input.parameters, "map_size"));
    map_.draw(context, {.kernel_radius = soft ? 4.0 : 0.5,
                        .border = soft ? size / 16.0 : 0.5,
                        .follows_extent = soft});
    nearest_.draw(context, map_);
  }

  void bind(vulkan::Bindings& bindings) const override {
    map_.bind(bindings);
    nearest_.bind(bindings);
  }

 private:
  shadow_maps::DepthMap map_;
  shadow_maps::NearestDepths nearest_;
};

}  // namespace

TechniqueDescription describe_pcss() {
  TechniqueDescription description;
  description.label = "PCSS";
  description.title = "Percentage-closer soft shadows";
  description.family = "map";
  description.source = "van Sambeek 2007, 2.2.5; Fernando 2005";
  description.parameters = pcss_parameters();
  description.diagnostics = shadow_maps::map_diagnostics(
      {{"blocker-depth", "Depth of the blocker that the search found; black where there is none."},
       {"penumbra-width", "Width of the filter; white is an eighth of the map."}});
  description.create = create_technique<PercentageCloserSoftShadows>;
  return description;
}

}  // namespace penumbra::techniques
