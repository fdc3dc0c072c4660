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

TechniqueDescription describe_soft_shadow_volumes();
TechniqueDescription describe_soft_shadow_volumes() {
  Parameter table_size;
  table_size.name = "table_size";
  table_size.type = ParameterType::integer;
  table_size.default_value = std::int64_t{64};
  table_size.minimum = 4;
  table_size.maximum = 128;
  table_size.scale = ParameterScale::logarithmic;
  table_size.meaning =
      "Places along each axis of the table that knows what part of the light lies beyond an edge.";

  Parameter accumulation;
  accumulation.name = "accumulation";
  accumulation.type = ParameterType::choice;
  accumulation.choices = {"float32", "float16"};
  accumulation.default_value = std::string("float32");
  accumulation.meaning = "Format of the image that the parts of the light are added up in.";

  Parameter overlap;
  overlap.name = "overlap";
  overlap.type = ParameterType::choice;
  overlap.choices = {"count", "add"};
  overlap.default_value = std::string("count");
  overlap.meaning =
      "Where penumbrae overlap. count: what several casters hide is found at 32 points of the "
      "light and counted once. add: it counts once for each caster, as published in 2003 and "
      "2007.";
  overlap.variant = true;

  TechniqueDescription description;
  description.id = "soft-shadow-volumes";
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
  description.shader = "techniques/soft-shadow-volumes/shadow.glsl";
  description.create = [] { return std::make_unique<SoftShadowVolumes>(); };
  return description;
}

}  // namespace penumbra::techniques
