#include "renderer/shadow_volumes/soft_volumes.h"

namespace penumbra::techniques {
namespace {

/// Soft shadows: hard volumes from the light's centre, corrected in penumbra wedges.
class SoftShadowVolumes : public Technique {
 public:
  void require(const TechniqueInput&, Requirements& needs) override {
    needs.casters = CasterUse::beam;
    needs.stencil = true;
    needs.adjacency = true;
  }
  void prepare(PrepareContext& context) override {
    const ParameterValues& parameters = context.input.parameters;
    shadow_volumes::SoftVolumeOptions options;
    if (choice_of(parameters, "accumulation") == "float16") options.format = VK_FORMAT_R16_SFLOAT;
    options.table_size = static_cast<std::uint32_t>(integer_of(parameters, "table_size"));
    options.count_overlaps = choice_of(parameters, "overlap") == "count";
    options.clamp = boolean_of(parameters, "clamp");
    volumes_.draw(context, options);
  }
  void bind(vulkan::Bindings& bindings) const override { volumes_.bind(bindings); }

 private:
  shadow_volumes::SoftVolumes volumes_;
};

}  // namespace

TechniqueDescription describe_soft_shadow_volumes() {
  const Parameter table_size = integer("table_size", 64, {4, 128},
                                       "Places along each axis of the table that knows what part "
                                       "of the light lies beyond an edge.")
                                   .log();

  const Parameter accumulation =
      choice("accumulation", "float32", {"float32", "float16"},
             "Format of the image that the parts of the light are added up in.");

  const Parameter overlap = choice("overlap", "count", {"count", "add"},
                                   "Where penumbrae overlap. count: what several casters hide is "
                                   "found at 32 points of the light and counted once. add: it "
                                   "counts once for each caster, as published in 2003 and 2007.")
                                .compiled();

  TechniqueDescription description;
  description.label = "SSV";
  description.title = "Soft shadow volumes";
  description.family = "volume";
  description.source =
      "van Sambeek 2007, 2.4.7 and 3.2.4; Akenine-Moeller and Assarsson 2002; Assarsson and "
      "Akenine-Moeller 2003";
  description.parameters = {shadow_volumes::clamp_parameter()};
  description.parameters.push_back(table_size);
  description.parameters.push_back(accumulation);
  description.parameters.push_back(overlap);
  description.diagnostics = {
      shadow_volumes::count_diagnostic(),
      {"wedges",
       "What the wedges of the first light add to the hidden part of it (red) or take away "
       "(blue); darker grey where its centre is hidden."}};
  description.create = create_technique<SoftShadowVolumes>;
  return description;
}

}  // namespace penumbra::techniques
