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

TEST_F(CameraPath, leaves_nothing_of_earlier_surfaces_in_the_sky) {
  // The picture's own camera sees sky above the ground, the one before it ground alone.
  Scene scene = *request.scene;
  Camera& own = scene.cameras.front();
  own.projection = Projection::perspective;
  own.position = {0.3, 0.6, 3.0};
  own.target = {0.0, 0.6, 0.0};
  own.up = {0.0, 1.0, 0.0};
  for (const bool even : {true, false}) {
    scene.background_low = {0.2f, 0.4f, 0.6f};
    scene.background_high = even ? scene.background_low : glm::vec3(0.9f);
    request.scene = std::make_shared<const Scene>(scene);
    Camera down = own;
    down.position = {0.1, 5.0, 0.1};
    down.target = {0.0, 0.0, 0.0};
    for (const TechniqueDescription& technique : techniques::all()) {
      const techniques::Resolved resolved = techniques::resolve(technique.id, {});
      request.technique = resolved.technique;
      request.parameters = resolved.parameters;
      request.light_samples = 16;
      request.earlier_cameras.clear();
      const Image8 alone = renderer.render(request).picture;
      const std::uint8_t* sky = alone.pixels.data();
      EXPECT_GT(sky[2], sky[0]) << technique.id << " shows no sky";
      request.earlier_cameras = {down};
      EXPECT_EQ(renderer.render(request).picture.pixels, alone.pixels) << technique.id;
    }
  }
}

/// Greatest distance between where a frame's points are seen and where its samples are, pixels.
double greatest_shift(const PathFrame& frame) {
  double greatest = 0.0;
  for (std::uint32_t y = 0; y < frame.points.height; ++y)
    for (std::uint32_t x = 0; x < frame.points.width; ++x) {
      const float* point = &frame.points.at(x, y, 0);
      if (point[3] < 0.5f) continue;
      const glm::dvec4 clip = frame.clip_from_world * glm::dvec4(point[0], point[1], point[2], 1.0);
      const glm::dvec2 at = (0.5 + 0.5 * glm::dvec2(clip) / clip.w) *
                            glm::dvec2(frame.points.width, frame.points.height);
      const glm::dvec2 shift = glm::abs(at - glm::dvec2(x, y) - frame.sample);
      greatest = std::max({greatest, shift.x, shift.y});
    }
  return greatest;
}

TEST_F(CameraPath, hands_over_each_frame_with_the_points_that_it_shows) {
  const techniques::Resolved resolved = techniques::resolve("pcf", {});
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.visibility = true;
  request.earlier_cameras = {standing_at(-1.0), standing_at(1.0)};
  RendererOptions small{.device = "", .validation = true};
  small.most_window_samples = 512;
  Renderer in_windows(small);
  for (const std::uint32_t samples : RenderLimits::supersampling) {
    request.supersampling = samples;
    for (Renderer* drawing : {&renderer, &in_windows}) {
      std::vector<PathFrame> frames;
      RenderControl control;
      control.path_frame = [&](PathFrame frame) { frames.push_back(std::move(frame)); };
      const RenderResult result = drawing->render(request, control);
      ASSERT_EQ(frames.size(), 3u);
      EXPECT_EQ(frames.back().visibility.pixels, result.visibility.pixels);
      EXPECT_EQ(frames.back().judged.pixels, result.judged.pixels);
      for (const PathFrame& frame : frames) EXPECT_LT(greatest_shift(frame), 0.01) << samples;
      EXPECT_NE(frames[0].visibility.pixels, frames[1].visibility.pixels);
      request.earlier_cameras.pop_back();
      EXPECT_EQ(drawing->render({request}).visibility.pixels, result.visibility.pixels);
      request.earlier_cameras.push_back(standing_at(1.0));
    }
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
