#include "renderer/plan/plan.h"

#include <gmock/gmock.h>

#include <random>

#include "renderer/error.h"
#include "renderer/scene/light_points.h"
#include "renderer/scene/transforms.h"
#include "scenes/library.h"
#include "techniques/registry.h"
#include "tests/conformance/plan/scattered.h"
#include "tests/conformance/scenes.h"
#include "tests/kept_pictures/kept_pictures.h"

namespace penumbra {
namespace {

using test::scattered;

RenderRequest request_of(Scene scene, const std::string& technique) {
  RenderRequest request;
  request.scene = std::make_shared<const Scene>(std::move(scene));
  request.technique = techniques::resolve(technique).technique;
  request.width = request.height = 48;
  request.light_samples = 32;
  request.visibility = true;
  return request;
}

Plan plan_of(const RenderRequest& request) {
  return make_plan(request, complete_parameters(request.technique->parameters, request.parameters),
                   instance_boxes(*request.scene));
}

Plan plan_of(const Scene& scene, const std::string& technique) {
  return plan_of(request_of(scene, technique));
}

PlanRules without_rules() {
  return {.lights = false, .surfaces = false, .casters = false, .textures = false};
}

/// Whether the camera sees a point, by the matrix that pictures are drawn with.
bool in_view(const CameraMatrices& camera, const glm::dvec3& point) {
  const glm::dvec4 clip = camera.clip_from_world * glm::dvec4(point, 1.0);
  return clip.w > 0.0 && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w &&
         clip.z >= 0.0 && clip.z <= clip.w;
}

/// Whether a segment meets a box (slabs).
bool meets(const Bounds& box, const glm::dvec3& from, const glm::dvec3& to) {
  double first = 0.0;
  double last = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = to[axis] - from[axis];
    double enter = (box.low[axis] - from[axis]) / step;
    double leave = (box.high[axis] - from[axis]) / step;
    if (enter > leave) std::swap(enter, leave);
    first = std::max(first, enter);
    last = std::min(last, leave);
  }
  return first <= last;
}

// The judge shoots rays and knows nothing of hulls: from points that the camera sees inside the
// light's cone to points on the light. Whatever a ray meets must be a caster.
TEST(Plan, keeps_every_instance_that_a_ray_from_a_visible_point_to_a_light_can_meet) {
  std::size_t met = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const Scene scene = scattered(seed);
    const Plan plan = plan_of(scene, "reference");
    const std::vector<Bounds> boxes = instance_boxes(scene);
    const CameraMatrices camera = camera_matrices(scene.cameras[0], glm::dvec3(0.0), 1.0, 50.0);
    std::mt19937 generator(seed);
    const auto unit = [&] { return static_cast<double>(generator()) / 4294967295.0; };
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
      const Light& light = scene.lights[l];
      const WorldLight world = world_light(light, glm::dvec3(0.0));
      const auto points = light_points(world, 64, 1, seed, true);
      for (int i = 0; i < 20000; ++i) {
        const Bounds& box = boxes[static_cast<std::size_t>(unit() * 0.999999 * boxes.size())];
        const glm::dvec3 seen = box.low + box.size() * glm::dvec3(unit(), unit(), unit());
        if (!in_view(camera, seen)) continue;
        const glm::dvec3 point(points[static_cast<std::size_t>(i) % points.size()]);
        glm::dvec3 source = point;
        if (light.kind == LightKind::directional) {
          source = seen + 100.0 * point;
        } else {
          const glm::dvec3 ray = seen - point;
          const double distance = glm::length(ray);
          if (glm::dot(ray, world.direction) < distance * std::cos(glm::radians(light.outer_angle)))
            continue;
          if (light.range > 0.0 && distance > light.range) continue;
        }
        EXPECT_TRUE(plan.lights[l]) << scene.id << " " << light.name;
        for (std::size_t b = 0; b < boxes.size(); ++b)
          if (meets(boxes[b], seen, source)) {
            ++met;
            ASSERT_TRUE(plan.instances[b].casts)
                << scene.id << ", " << light.name << ": " << scene.instances[b].name;
          }
      }
    }
  }
  EXPECT_GT(met, 10000u);
}

TEST(Plan, keeps_every_instance_of_which_the_camera_may_see_a_point) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const Scene scene = scattered(seed);
    const Plan plan = plan_of(scene, "none");
    const std::vector<Bounds> boxes = instance_boxes(scene);
    const CameraMatrices camera = camera_matrices(scene.cameras[0], glm::dvec3(0.0), 1.0, 50.0);
    std::mt19937 generator(seed);
    const auto unit = [&] { return static_cast<double>(generator()) / 4294967295.0; };
    for (int i = 0; i < 10000; ++i) {
      const std::size_t b = static_cast<std::size_t>(i) % boxes.size();
      const glm::dvec3 point = boxes[b].low + boxes[b].size() * glm::dvec3(unit(), unit(), unit());
      EXPECT_TRUE(plan.instances[b].visible || !in_view(camera, point))
          << scene.id << ": " << scene.instances[b].name;
    }
  }
}

TEST(Plan, drops_something_by_every_rule) {
  std::size_t lights = 0, surfaces = 0, casters = 0, textures = 0;
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    const Plan plan = plan_of(scattered(seed), "reference");
    lights += std::count(plan.lights.begin(), plan.lights.end(), false);
    textures += std::count(plan.textures.begin(), plan.textures.end(), false);
    for (const InstanceUse& use : plan.instances) {
      surfaces += !use.visible;
      casters += !use.casts;
    }
  }
  EXPECT_GE(lights, 1u);
  EXPECT_GE(surfaces, 12u);
  EXPECT_GE(casters, 12u);
  EXPECT_GE(textures, 12u);
}

TEST(Plan, says_of_everything_why) {
  const Scene scene = scattered(1);
  const Plan plan = plan_of(scene, "shadow-volumes");
  std::map<std::string, std::size_t> lines;
  for (const PlanLine& line : plan.lines) {
    ++lines[line.rule];
    EXPECT_NE(line.reason, "") << line.rule << " " << line.subject;
  }
  EXPECT_EQ(lines["lights"], scene.lights.size());
  EXPECT_EQ(lines["surfaces"], scene.instances.size());
  EXPECT_EQ(lines["casters"], scene.instances.size());
  EXPECT_EQ(lines["textures"], scene.textures.size());
  EXPECT_EQ(lines["adjacency"] + lines["stencil"] + lines["hierarchy"], 3u);
}

// Each case moves one thing just inside or outside what matters.
class PlanEdge : public testing::Test {
 protected:
  Scene scene = test::box_on_ground();
  InstanceUse box(const std::string& technique) {
    return plan_of(scene, technique).instances.at(1);
  }
  void move_box(const glm::dvec3& by) {
    scene.instances[1].world_from_object[3] += glm::dvec4(by, 0);
  }
};

TEST_F(PlanEdge, a_box_beside_the_picture_is_not_drawn_but_casts_into_it) {
  move_box({1.4, 1.5, 0.5});  // the picture ends at x = 1, the light hangs at x = 1.5
  EXPECT_FALSE(box("reference").visible);
  EXPECT_TRUE(box("reference").casts);
}

TEST_F(PlanEdge, a_box_behind_everything_visible_casts_nothing) {
  move_box({-1.6, 0, 0});  // its shadow falls away from the picture
  EXPECT_FALSE(box("reference").visible);
  EXPECT_FALSE(box("reference").casts);
}

TEST_F(PlanEdge, a_box_that_only_a_wider_light_hides_is_a_caster_of_the_wide_light_alone) {
  move_box({2.1, 1.0, 0.5});
  EXPECT_FALSE(box("reference").casts);
  scene.lights[0].extent.radius = 3.0;
  EXPECT_TRUE(box("reference").casts);
}

TEST_F(PlanEdge, filters_keep_what_stands_around_the_beam) {
  move_box({-1.6, 0, 0});
  EXPECT_TRUE(box("pcf").casts);
  move_box({0, 8, 0});  // behind the light
  EXPECT_FALSE(box("pcf").casts);
}

TEST_F(PlanEdge, no_shadows_have_no_casters) {
  EXPECT_FALSE(box("none").casts);
  EXPECT_TRUE(box("none").visible);
}

TEST_F(PlanEdge, a_light_that_was_turned_away_or_off_is_dropped) {
  EXPECT_TRUE(plan_of(scene, "none").lights[0]);
  scene.lights[0].direction = {0, 1, 0};
  EXPECT_FALSE(plan_of(scene, "none").lights[0]);
  scene = test::box_on_ground();
  scene.lights[0].intensity = 0.0f;
  EXPECT_FALSE(plan_of(scene, "none").lights[0]);
  scene = test::box_on_ground();
  scene.lights[0].range = 3.0;  // it hangs 4 m above the ground
  EXPECT_FALSE(plan_of(scene, "none").lights[0]);
  scene.lights[0].range = 4.5;
  EXPECT_TRUE(plan_of(scene, "none").lights[0]);
}

/// A box on a floor, and in the light's cone something far below, beside what the camera sees.
Scene floor_above_a_distant_thing() {
  Scene scene = test::box_on_ground();
  test::add_box(scene, {3, -40000, -1}, {5, -39990, 1});
  return scene;
}

TEST(Plan, leaves_the_order_of_surfaces_that_coincide) {
  // Of two boxes at one place the first that is drawn is seen. One shares its material with a large
  // thing beside the picture, and materials come in the order of the largest things.
  Scene scene = test::open_ground();
  const auto add = [&](const glm::vec3& color, const glm::dvec3& low, const glm::dvec3& high) {
    test::add_box(scene, low, high);
    scene.materials.emplace_back();
    scene.materials.back().base_color = color;
    scene.meshes.back().primitives[0].material =
        static_cast<std::uint32_t>(scene.materials.size() - 1);
  };
  add({1, 0, 0}, {-0.5, 0.1, -0.5}, {0.5, 0.3, 0.5});
  add({0, 0, 1}, {-0.5, 0.1, -0.5}, {0.5, 0.3, 0.5});
  test::add_box(scene, {50, -10, 50}, {90, 0, 90});
  scene.meshes.back().primitives[0].material =
      static_cast<std::uint32_t>(scene.materials.size() - 2);
  RenderRequest request = request_of(scene, "none");
  EXPECT_FALSE(plan_of(request).instances.back().visible);
  const RenderResult planned = test::renderer().render(request);
  request.rules = without_rules();
  const RenderResult whole = test::renderer().render(request);
  EXPECT_EQ(planned.picture.pixels, whole.picture.pixels);
  EXPECT_GT(whole.picture.at(24, 24, 2), whole.picture.at(24, 24, 0)) << "the blue one is seen";
}

double false_and_missing(const RenderResult& result, const RenderResult& truth) {
  const auto error = tests::visibility_error(result.visibility, truth.visibility, result.judged);
  return error.false_shadow + error.missing_shadow;
}

TEST(DepthRange, ends_at_the_farthest_surface_that_is_seen_and_lit) {
  RenderRequest request = request_of(floor_above_a_distant_thing(), "shadow-map");
  request.rules.surfaces = request.rules.casters = false;
  const Plan plan = plan_of(request);
  Bounds receivers;
  for (const Bounds& box : plan.fits[0].receivers) receivers.add(box);
  EXPECT_GT(receivers.low.y, -1.0);
  request.rules.depth_range = false;
  for (const Bounds& box : plan_of(request).fits[0].receivers) receivers.add(box);
  EXPECT_LT(receivers.low.y, -30000.0);
}

TEST(DepthRange, spares_maps_of_few_bits_the_depth_that_nothing_needs) {
  RenderRequest truth = request_of(floor_above_a_distant_thing(), "ray-traced");
  const RenderResult exact = test::renderer().render(truth);
  RenderRequest request = request_of(floor_above_a_distant_thing(), "shadow-map");
  request.parameters["depth_bits"] = std::string("16");
  const auto missing = [&] {
    const RenderResult result = test::renderer().render(request);
    return tests::visibility_error(result.visibility, exact.visibility, result.judged)
        .missing_shadow;
  };
  // Over the whole depth a step would be half a metre, and the box, half a metre high, cast
  // nothing.
  EXPECT_LT(missing(), 0.001);
  // Without this rule the scene's frame spares them: maps look no farther than its reach.
  request.rules.depth_range = false;
  EXPECT_LT(missing(), 0.001);
}

TEST(DepthRange, never_raises_an_error_by_fitting) {
  for (const char* id : {"car", "boxes", "disco-box", "island", "warehouse-outside"})
    for (const char* technique : {"esm-log", "shadow-map"}) {
      SCOPED_TRACE(std::string(id) + ", " + technique);
      const auto resolved = techniques::resolve(technique);
      RenderRequest request = request_of(*scenes::load(id), resolved.technique->id);
      RenderRequest truth = request;
      truth.technique = techniques::resolve("ray-traced").technique;
      const RenderResult exact = test::renderer().render(truth);
      request.parameters = resolved.parameters;
      if (technique == std::string("shadow-map"))
        request.parameters["depth_bits"] = std::string("16");
      const double fitted = false_and_missing(test::renderer().render(request), exact);
      request.rules.depth_range = false;
      // Filters round: a thousandth of the pixels may fall on either side.
      EXPECT_LE(fitted, false_and_missing(test::renderer().render(request), exact) + 0.001);
    }
}

// What the plan costs and saves is seen on the device.
const PassCost& pass_of(const RenderResult& result, const std::string& name) {
  for (const PassCost& pass : result.cost.passes)
    if (pass.name == name) return pass;
  throw std::runtime_error("no pass " + name);
}

TEST(PlannedRender, an_unlit_caster_costs_the_map_nothing) {
  Scene scene = test::box_on_ground();
  const RenderResult before = test::renderer().render(request_of(scene, "shadow-map"));
  test::add_box(scene, {30, 0, 30}, {31, 1, 31});
  const RenderResult after = test::renderer().render(request_of(scene, "shadow-map"));
  EXPECT_EQ(pass_of(before, "shadow map").vertices, pass_of(after, "shadow map").vertices);
  EXPECT_EQ(pass_of(before, "geometry").vertices, pass_of(after, "geometry").vertices);
}

TEST(PlannedRender, a_light_without_extent_costs_one_point_of_many) {
  Scene scene = test::box_on_ground();
  const RenderResult soft = test::renderer().render(request_of(scene, "reference"));
  scene.lights[0].extent = {};
  const RenderResult hard = test::renderer().render(request_of(scene, "reference"));
  const auto invocations = [](const RenderResult& result) {
    std::uint64_t sum = 0;
    for (const PassCost& pass : result.cost.passes)
      if (pass.name != "geometry" && pass.name != "resolve")
        sum += pass.fragment_invocations + pass.compute_invocations;
    return sum;
  };
  EXPECT_LE(invocations(hard), invocations(soft));
  EXPECT_NE(hard.picture.pixels, soft.picture.pixels);
}

TEST(PlannedRender, draws_a_picture_of_nothing) {
  Scene scene = test::box_on_ground();
  scene.cameras[0].position = {0, 3, 0};
  scene.cameras[0].target = {0, 6, 0};
  for (const std::string technique : {"none", "shadow-map", "shadow-volumes", "reference"}) {
    SCOPED_TRACE(technique);
    const RenderResult result = test::renderer().render(request_of(scene, technique));
    EXPECT_THAT(result.judged.pixels, testing::Each(0.0f));
    EXPECT_THAT(result.visibility.pixels, testing::Each(1.0f));
  }
}

class PlannedTechnique : public testing::TestWithParam<std::string> {};

TEST_P(PlannedTechnique, draws_the_same_bytes_with_and_without_each_rule) {
  for (const std::uint32_t seed : {1u, 2u}) {
    SCOPED_TRACE(seed);
    RenderRequest request = request_of(scattered(seed), GetParam());
    RenderResult planned;
    try {
      planned = test::renderer().render(request);
    } catch (const Error& error) {
      ASSERT_EQ(error.code, "unsupported") << error.what();
      continue;
    }
    std::vector<PlanRules> variants{without_rules()};
    if (seed == 1)
      for (bool PlanRules::*rule :
           {&PlanRules::lights, &PlanRules::surfaces, &PlanRules::casters, &PlanRules::textures}) {
        variants.emplace_back();
        variants.back().*rule = false;
      }
    for (const PlanRules& rules : variants) {
      request.rules = rules;
      const RenderResult result = test::renderer().render(request);
      EXPECT_TRUE(tests::same(result.picture, planned.picture));
      EXPECT_TRUE(tests::same(result.visibility, planned.visibility));
      EXPECT_TRUE(tests::same(result.judged, planned.judged));
    }
  }
}

std::vector<std::string> technique_ids() {
  std::vector<std::string> ids;
  for (const auto& technique : techniques::all()) ids.push_back(technique.id);
  return ids;
}

INSTANTIATE_TEST_SUITE_P(Every, PlannedTechnique, testing::ValuesIn(technique_ids()),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace penumbra
