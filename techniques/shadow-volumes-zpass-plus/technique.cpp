#include "renderer/shadow_volumes/stencil_volumes.h"

namespace penumbra::techniques {
namespace {

/// Hard shadows by volumes counted between camera and surface, from a count that starts with the
/// volumes which the near plane lies in (z-pass+): right wherever the camera stands.
class ShadowVolumesZPassPlus : public Technique {
 public:
  void require(const TechniqueInput&, Requirements& needs) override {
    needs.casters = CasterUse::beam;
    needs.stencil = true;
    needs.adjacency = true;
  }
  void prepare(PrepareContext& context) override {
    shadow_volumes::VolumeOptions options =
        shadow_volumes::volume_options(context.input.parameters);
    options.counting = shadow_volumes::Counting::before;
    options.near_caps = true;
    volumes_.draw(context, options);
  }
  void bind(vulkan::Bindings& bindings) const override { volumes_.bind(bindings); }

 private:
  shadow_volumes::StencilVolumes volumes_;
};

}  // namespace

TechniqueDescription describe_shadow_volumes_zpass_plus() {
  TechniqueDescription description;
  description.label = "SV z-pass+";
  description.title = "Shadow volumes, z-pass+";
  description.family = "volume";
  description.source = "Hornus, Hoberock, Lefebvre and Hart 2005";
  description.parameters = shadow_volumes::volume_parameters();
  description.diagnostics = {shadow_volumes::count_diagnostic()};
  description.shader = "renderer/shadow_volumes/stencil_shadow.glsl";
  description.create = create_technique<ShadowVolumesZPassPlus>;
  return description;
}

}  // namespace penumbra::techniques
