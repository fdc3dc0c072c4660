#include "renderer/shadow_volumes/stencil_volumes.h"

namespace penumbra::techniques {
namespace {

/// Exact hard shadows: volumes counted behind the visible surface (z-fail).
class ShadowVolumes : public Technique {
 public:
  void require(const TechniqueInput&, Requirements& needs) override {
    needs.casters = CasterUse::beam;
    needs.stencil = true;
    needs.adjacency = true;
  }
  void prepare(PrepareContext& context) override {
    shadow_volumes::VolumeOptions options =
        shadow_volumes::volume_options(context.input.parameters);
    options.automatic = choice_of(context.input.parameters, "counting") == "automatic";
    volumes_.draw(context, options);
  }
  void bind(vulkan::Bindings& bindings) const override { volumes_.bind(bindings); }

 private:
  shadow_volumes::StencilVolumes volumes_;
};

}  // namespace

TechniqueDescription describe_shadow_volumes() {
  const Parameter counting =
      choice("counting", "behind", {"behind", "automatic"},
             "behind: all volumes are counted behind the surface (z-fail). automatic: before it "
             "(z-pass) where the caster's shadow provably does not reach the camera's near plane.");

  TechniqueDescription description;
  description.label = "SV";
  description.title = "Shadow volumes";
  description.family = "volume";
  description.source = "van Sambeek 2007, 2.4.3 and 3.2.4; Everitt and Kilgard 2002";
  description.parameters = shadow_volumes::volume_parameters();
  description.parameters.push_back(counting);
  description.parameters.push_back(shadow_volumes::ablation_parameter());
  description.diagnostics = {shadow_volumes::count_diagnostic()};
  description.shader = "renderer/shadow_volumes/stencil_shadow.glsl";
  description.create = create_technique<ShadowVolumes>;
  return description;
}

}  // namespace penumbra::techniques
