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
    shadow_volumes::VolumeOptions options;
    options.clamp = boolean_of(context.input.parameters, "clamp");
    volumes_.draw(context, options);
  }
  void bind(vulkan::Bindings& bindings) const override { volumes_.bind(bindings); }

 private:
  shadow_volumes::StencilVolumes volumes_;
};

}  // namespace

TechniqueDescription describe_shadow_volumes();
TechniqueDescription describe_shadow_volumes() {
  TechniqueDescription description;
  description.id = "shadow-volumes";
  description.label = "SV";
  description.title = "Shadow volumes";
  description.family = "volume";
  description.source = "van Sambeek 2007, 2.4.3 and 3.2.4; Everitt and Kilgard 2002";
  description.parameters = shadow_volumes::volume_parameters();
  description.diagnostics = {shadow_volumes::count_diagnostic()};
  description.shader = "renderer/shadow_volumes/stencil_shadow.glsl";
  description.create = [] { return std::make_unique<ShadowVolumes>(); };
  return description;
}

}  // namespace penumbra::techniques
