#include "renderer/shadow_volumes/stencil_volumes.h"

namespace penumbra::techniques {
namespace {

/// Hard shadows by three sides of every lit triangle, counted between camera and surface.
class BruteForceShadowVolumes : public Technique {
 public:
  void require(const TechniqueInput&, Requirements& needs) override {
    needs.casters = CasterUse::all;  // a volume around the camera spoils the count everywhere
    needs.stencil = true;
  }
  void prepare(PrepareContext& context) override {
    shadow_volumes::VolumeOptions options =
        shadow_volumes::volume_options(context.input.parameters);
    options.every_edge = true;
    options.counting = shadow_volumes::Counting::before;
    volumes_.draw(context, options);
  }
  void bind(vulkan::Bindings& bindings) const override { volumes_.bind(bindings); }

 private:
  shadow_volumes::StencilVolumes volumes_;
};

}  // namespace

TechniqueDescription describe_shadow_volumes_brute_force() {
  TechniqueDescription description;
  description.label = "SV brute";
  description.title = "Shadow volumes, brute force";
  description.family = "volume";
  description.source = "van Sambeek 2007, 2.4.1 and 3.2.4; Crow 1977";
  description.parameters = shadow_volumes::volume_parameters();
  description.diagnostics = {shadow_volumes::count_diagnostic()};
  description.shader = "renderer/shadow_volumes/stencil_shadow.glsl";
  description.create = create_technique<BruteForceShadowVolumes>;
  return description;
}

}  // namespace penumbra::techniques
