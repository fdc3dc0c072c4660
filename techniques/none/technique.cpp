#include "renderer/technique.h"

namespace penumbra::techniques {
namespace {

/// Lights every point that faces the light inside its cone: what shadows are compared with.
class None : public Technique {
 public:
  void require(const TechniqueInput&, Requirements& needs) override {
    needs.casters = CasterUse::none;
    needs.reads_sky = false;
  }
  void prepare(PrepareContext&) override {}
  void bind(vulkan::Bindings&) const override {}
};

}  // namespace

TechniqueDescription describe_none() {
  TechniqueDescription description;
  description.label = "No";
  description.title = "No shadows";
  description.family = "none";
  description.source = "van Sambeek 2007, 3.2.4";
  description.create = create_technique<None>;
  return description;
}

}  // namespace penumbra::techniques
