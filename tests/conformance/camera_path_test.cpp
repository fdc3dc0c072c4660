// What a technique sees of the frames that go before a picture's own.
#include <gmock/gmock.h>

#include "renderer/error.h"
#include "renderer/frame/prepare_context.h"
#include "renderer/render.h"
#include "techniques/presets.h"
#include "techniques/registry.h"
#include "tests/conformance/scenes.h"

namespace penumbra {
namespace {

constexpr EmbeddedFile path_shaders[] = {{"test/lit_shadow.glsl", R"(
float calculate_shadow(ShadowQuery query) { return 1.0; }
)"}};

/// Notes, in each frame, how many frames it has drawn and where the camera stands.
class Witness : public Technique {
 public:
  void require(const TechniqueInput&, Requirements& needs) override {
    needs.casters = CasterUse::none;
  }
  void prepare(PrepareContext& context) override {
    seen_ += std::to_string(std::lround(context.input.camera.position.x)) + " ";
    // The matrices must be of the same camera: the point in front of it lies in their middle.
    const glm::dvec3 ahead = context.input.camera.target - context.scene.origin();
    const glm::dvec4 clip = context.picture_camera.clip_from_world * glm::dvec4(ahead, 1.0);
    if (std::abs(clip.x / clip.w) > 1e-6 || std::abs(clip.y / clip.w) > 1e-6) seen_ += "askew ";
    context.notes.push_back("cameras at " + seen_);
  }
  void bind(vulkan::Bindings&) const override {}

 private:
  std::string seen_;
};

TechniqueDescription witness() {
  TechniqueDescription description;
  description.id = "witness";
  description.family = "none";
  description.label = "WIT";
  description.title = "Frames that were drawn";
  description.source = "none: a test";
  description.shader = "test/lit_shadow.glsl";
  description.create = [] { return std::make_unique<Witness>(); };
  TechniqueDescription finished = techniques::finish_descriptions({description}).front();
  finished.files = path_shaders;
  return finished;
}

class CameraPath : public testing::Test {
 protected:
  CameraPath() {
    request.scene = std::make_shared<const Scene>(test::box_on_ground());
    request.width = request.height = 32;
  }

  Camera standing_at(double x) const {
    Camera camera = request.scene->cameras.front();
    camera.position.x = x;
    return camera;
  }

  Renderer renderer{{.device = "", .validation = true}};
  RenderRequest request;
};

TEST_F(CameraPath, is_drawn_in_order_by_one_fresh_instance) {
  const TechniqueDescription description = witness();
  request.technique = &description;
  Scene scene = *request.scene;
  scene.cameras.front().position.x = 5.0;
  request.scene = std::make_shared<const Scene>(scene);
  request.earlier_cameras = {standing_at(-3.0), standing_at(7.0), standing_at(2.0)};
  for (int again = 0; again < 2; ++again)
    EXPECT_THAT(renderer.render(request).notes, testing::Contains("cameras at -3 7 2 5 "));
  // A frame's notes are of the picture, not of the frames before it.
  EXPECT_THAT(renderer.render(request).notes, testing::Not(testing::Contains("cameras at -3 ")));
}

TEST_F(CameraPath, changes_no_picture_of_a_technique_without_memory) {
  for (const char* technique : {"pcf", "shadow-volumes", "hybrid"}) {
    const techniques::Resolved resolved = techniques::resolve(technique, {});
    request.technique = resolved.technique;
    request.parameters = resolved.parameters;
    request.earlier_cameras.clear();
    const Image8 alone = renderer.render(request).picture;
    // One of them looks away from everything.
    Camera away = standing_at(3.0);
    away.target = away.position + glm::dvec3(0.1, 1.0, 0.0);
    request.earlier_cameras = {standing_at(-4.0), away};
    EXPECT_EQ(renderer.render(request).picture.pixels, alone.pixels) << technique;
  }
}

TEST_F(CameraPath, has_a_bound_and_cameras_that_can_draw) {
  const techniques::Resolved resolved = techniques::resolve("none", {});
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.earlier_cameras.assign(RenderLimits::max_camera_path, standing_at(1.0));
  EXPECT_THROW(renderer.render(request), Error);
  request.earlier_cameras.assign(2, standing_at(1.0));
  request.earlier_cameras[1].up = glm::dvec3(0.0);
  EXPECT_THROW(renderer.render(request), Error);
}

}  // namespace
}  // namespace penumbra
