#include "renderer/reference/occlusion_mask.h"
#include "renderer/scene/light.h"

namespace penumbra::techniques {
namespace {

/// The mean over points of the light's extent of exact hard shadows: the truth of every other
/// technique.
class Reference : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    const bool extended = has_extent(input.light);
    needs.casters = CasterUse::beam;
    needs.acceleration_structure = true;
    needs.light_points = extended ? input.light_samples : 1;
    needs.shade_each_point = choice_of(input.parameters, "mode") == "shaded";
    needs.scrambles = true;
    needs.random_points = choice_of(input.parameters, "sampling") == "random";
  }
  void prepare(PrepareContext& context) override { mask_.trace(context); }
  void bind(vulkan::Bindings& bindings) const override { mask_.bind(bindings); }
  const SampleList* lit_samples() const override { return mask_.lit_samples(); }

 private:
  reference::OcclusionMask mask_;
};

}  // namespace

TechniqueDescription describe_reference() {
  TechniqueDescription description;
  description.label = "REF";
  description.title = "Converged area light";
  description.family = "truth";
  description.source = "van Sambeek 2007, 4.1.2";
  description.parameters = {
      choice("mode", "shaded", {"shaded", "visibility"},
             "shaded: light comes from each point of the extent in turn. visibility: all light "
             "comes from the centre, as techniques have it, times the visible share of the extent.")
          .compiled(),
      choice("sampling", "low-discrepancy", {"low-discrepancy", "random"},
             "How the points lie on the extent. low-discrepancy: Sobol' points with Owen's "
             "scrambling. random: independent.")
          .compiled()};
  description.diagnostics = {
      {"uncertainty",
       "Standard error of the first light's brightness, over 16 scrambles of its points: black "
       "below 1/1024 of a level of 255 in linear light, white from one level on, logarithmic "
       "between.",
       true}};
  description.create = create_technique<Reference>;
  return description;
}

}  // namespace penumbra::techniques
