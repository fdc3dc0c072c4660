#include "renderer/shadow_volumes/stencil_volumes.h"

namespace penumbra::techniques {
namespace {

/// Hard shadows by volumes counted between camera and surface (z-pass): no caps, and inverted where
/// the camera is in a volume itself.
class ShadowVolumesZPass : public Technique {
 public:
  void require(const TechniqueInput&, Requirements& needs) override {
    needs.casters = CasterUse::all;  // a volume around the camera spoils the count everywhere
    needs.stencil = true;
    needs.adjacency = true;
  }
  void prepare(PrepareContext& context) override {
    shadow_volumes::VolumeOptions options =
        shadow_volumes::volume_options(context.input.parameters);
    options.counting = shadow_volumes::Counting::before;
    volumes_.draw(context, options);
  }
  void bind(vulkan::Bindings& bindings) const override { volumes_.bind(bindings); }

 private:
  shadow_volumes::StencilVolumes volumes_;
};

}  // namespace

TechniqueDescription describe_shadow_volumes_zpass() {
  TechniqueDescription description;
  description.label = "SV z-pass";
  description.title = "Shadow volumes, z-pass";
  description.family = "volume";
  description.source = "van Sambeek 2007, 2.4.2 and 3.2.4; Heidmann 1991";
  description.parameters = shadow_volumes::volume_parameters();
  description.diagnostics = {shadow_volumes::count_diagnostic()};
  description.shader = "renderer/shadow_volumes/stencil_shadow.glsl";
  description.create = create_technique<ShadowVolumesZPass>;
  return description;
}

}  // namespace penumbra::techniques
