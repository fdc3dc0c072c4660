#include "renderer/reference/occlusion_mask.h"

namespace penumbra::techniques {
namespace {

/// Shadow rays to a few points of the extent; one ray goes to its centre.
class RayTraced : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    const bool extended = input.light.extent.kind != ExtentKind::none;
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

TechniqueDescription describe_ray_traced();
TechniqueDescription describe_ray_traced() {
  Parameter rays;
  rays.name = "rays";
  rays.type = ParameterType::integer;
  rays.default_value = std::int64_t{1};
  rays.minimum = 1;
  rays.maximum = 1024;
  rays.scale = ParameterScale::logarithmic;
  rays.meaning =
      "Shadow rays per pixel and light, to low-discrepancy points of the extent. One ray goes to "
      "the "
      "centre: exact hard shadows.";

  TechniqueDescription description;
  description.id = "ray-traced";
  description.label = "RT";
  description.title = "Ray-traced shadows";
  description.family = "traced";
  description.source = "Whitted 1980; Cook, Porter and Carpenter 1984";
  description.parameters = {rays};
  description.shader = "techniques/ray-traced/shadow.glsl";
  description.create = [] { return std::make_unique<RayTraced>(); };
  return description;
}

}  // namespace penumbra::techniques
