#include "renderer/reference/occlusion_mask.h"
#include "renderer/scene/light.h"

namespace penumbra::techniques {
namespace {

/// Shadow rays to a few points of the extent; one ray goes to its centre.
class RayTraced : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    const bool extended = has_extent(input.light);
    needs.casters = CasterUse::beam;
    needs.acceleration_structure = true;
    needs.light_points =
        extended ? static_cast<std::uint32_t>(integer_of(input.parameters, "rays")) : 1;
  }
  void prepare(PrepareContext& context) override { mask_.trace(context); }
  void bind(vulkan::Bindings& bindings) const override { mask_.bind(bindings); }
  const SampleList* lit_samples() const override { return mask_.lit_samples(); }

 private:
  reference::OcclusionMask mask_;
};

}  // namespace

TechniqueDescription describe_ray_traced() {
  const Parameter rays = integer("rays", 1, {1, 1024},
                                 "Shadow rays per pixel and light, to low-discrepancy points of "
                                 "the extent. One ray goes to the centre: exact hard shadows.")
                             .log();

  TechniqueDescription description;
  description.label = "RT";
  description.title = "Ray-traced shadows";
  description.family = "traced";
  description.source = "Whitted 1980; Cook, Porter and Carpenter 1984";
  description.parameters = {rays};
  description.create = create_technique<RayTraced>;
  return description;
}

}  // namespace penumbra::techniques
