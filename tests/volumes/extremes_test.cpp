// Scenes and settings at the ends of what floats bear, against rays in double precision.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/error.h"
#include "tests/kept_pictures/kept_pictures.h"
#include "tests/volumes/drawing.h"
#include "tests/volumes/exact_rays.h"

namespace penumbra {
namespace extremes_test {

using test::draw;
constexpr std::uint32_t width = 96;

/// A turned crate, a ball and a lamp on a ground of that half size; all lengths times `scale`, all
/// places moved by `offset`.
Scene gallery(double ground = 6.0, double scale = 1.0, const glm::dvec3& offset = glm::dvec3(0.0)) {
  scenes::SceneBuilder b("gallery", "Gallery");
  const glm::dmat4 placed = glm::scale(glm::translate(glm::dmat4(1.0), offset), glm::dvec3(scale));
  const scenes::Look grey = b.look("grey", glm::vec3(0.7f));
  b.place(scenes::box({-ground, -0.2, -ground}, {ground, 0.0, ground}), grey, "ground", placed);
  b.place(scenes::box({-0.5, 0.3, -0.5}, {0.5, 1.1, 0.5}), grey, "crate",
          placed * glm::rotate(glm::dmat4(1.0), 0.4, glm::dvec3(0.0, 1.0, 0.0)));
  b.place(scenes::sphere(0.4, 20, 10), grey, "ball",
          placed * glm::translate(glm::dmat4(1.0), {1.3, 0.6, 0.4}));
  const auto at = [&](const glm::dvec3& p) { return glm::dvec3(placed * glm::dvec4(p, 1.0)); };
  b.spot("lamp", at({-2.0, 5.0, 2.5}), at({0.0, 0.0, 0.0}), glm::vec3(1.0f), 1.0f, 40.0, {});
  b.camera("main", at({2.5, 3.0, 5.0}), at({0.3, 0.4, 0.0}), 40.0);
  b.scene.cameras[0].near_plane *= scale;
  return b.scene;
}

struct Judged {
  double dark = 0.0, wrong = 0.0;  ///< shares of the pixels that face the light
  double rms = 0.0;
};

Judged judge(const RenderResult& result, const std::vector<int>& truth) {
  Judged judged;
  double count = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] < 0 || result.judged.pixels[i] < 1.0f) continue;
    const double off = std::abs(result.visibility.pixels[i] - static_cast<float>(truth[i]));
    ++count;
    judged.dark += truth[i] == 0;
    judged.wrong += off > 0.5;
    judged.rms += off * off;
  }
  judged.dark /= count;
  judged.wrong /= count;
  judged.rms = std::sqrt(judged.rms / count);
  return judged;
}

Judged judge(const Scene& scene, const std::string& technique,
             const ParameterValues& parameters = {}) {
  return judge(draw(scene, technique, parameters, {}, width),
               test::exact_visibility(scene, {}, width));
}

TEST(Rays, start_on_their_surface_however_large_the_scene) {
  for (const double ground : {6.0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8}) {
    const Judged judged = judge(gallery(ground), "ray-traced");
    EXPECT_GT(judged.dark, 0.05) << ground;
    EXPECT_LT(judged.wrong, 0.002) << "ground of " << ground << " m";
  }
  for (const double distance : {1e3, 1e4, 1e5}) {
    Scene scene = gallery();
    scene.instances.push_back(scene.instances[1]);
    scene.instances.back().world_from_object[3].x += distance;
    EXPECT_LT(judge(scene, "ray-traced").wrong, 0.002) << "a crate " << distance << " m away";
  }
}

TEST(Rays, reach_a_lamp_that_all_but_touches_their_surface) {
  for (const double height : {1e-2, 1e-4, 1e-6}) {
    Scene scene = gallery();
    scene.lights[0].kind = LightKind::point;
    scene.lights[0].position = {0.6, height, 1.6};
    EXPECT_LT(judge(scene, "ray-traced").wrong, 0.003) << height;
  }
}

TEST(Rays, do_not_meet_the_slivers_that_they_start_on) {
  scenes::SceneBuilder b("fan", "A fan");
  scenes::Solid fan;
  constexpr std::uint32_t slices = 4096;
  fan.add_point({0.0, 0.0, 0.0});
  for (std::uint32_t i = 0; i < slices; ++i) {
    const double angle = 6.283185307179586 * i / slices;
    fan.add_point({3.0 * std::cos(angle), 0.0, 3.0 * std::sin(angle)});
  }
  for (std::uint32_t i = 0; i < slices; ++i) fan.add_triangle(0, 1 + (i + 1) % slices, 1 + i);
  b.scene = gallery();
  const glm::dmat4 tilted = glm::rotate(glm::translate(glm::dmat4(1.0), {0.2, 0.25, -0.6}), 0.1,
                                        glm::normalize(glm::dvec3(1.0, 0.2, 0.4)));
  b.place(fan, {0, 1.0}, "fan", tilted);
  EXPECT_LT(judge(b.scene, "ray-traced").wrong, 0.003);
}

TEST(Rays, are_as_exact_in_a_small_scene_off_the_grid) {
  for (const double scale : {1e-3, 1e-4})
    for (const double off : {0.0, 0.3, 0.49}) {
      const Judged judged = judge(gallery(6.0, scale, glm::dvec3(off)), "ray-traced");
      EXPECT_GT(judged.dark, 0.05);
      EXPECT_LT(judged.wrong, 0.003) << scale << " at " << off;
    }
}

TEST(Rays, are_exact_in_a_view_that_is_zoomed_far) {
  Scene scene = gallery();
  Camera& camera = scene.cameras[0];
  camera.target = {1.0, 0.0, -0.6};
  for (const double field : {1.0, 0.1}) {
    camera.vertical_fov = field;
    EXPECT_LT(judge(scene, "ray-traced").wrong, 0.02) << field;
  }
}

/// Radiance of the picture's middle under a spot of this cone over that under a point light.
double share_of_cone(double inner, double outer, double off_axis) {
  scenes::SceneBuilder b("cone", "A narrow cone");
  b.ground({-50.0, -50.0}, {50.0, 50.0}, b.look("white", glm::vec3(0.8f)));
  b.camera("main", {0.0, 3.0, 0.0}, {0.0, 0.0, 0.0}, 0.02);
  b.scene.cameras[0].up = {0.0, 0.0, -1.0};
  constexpr double height = 1000.0;
  const double aside = height * std::tan(glm::radians(off_axis));
  b.spot("lamp", {0.0, height, 0.0}, {aside, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, outer, {});
  b.scene.lights[0].inner_angle = inner;
  b.scene.ambient = glm::vec3(0.0f);
  double radiance[2];
  for (const bool point : {false, true}) {
    if (point) b.scene.lights[0].kind = LightKind::point;
    const auto resolved = techniques::resolve("none", {});
    RenderRequest request;
    request.scene = std::make_shared<const Scene>(b.scene);
    request.technique = resolved.technique;
    request.parameters = resolved.parameters;
    request.width = request.height = 8;
    request.linear = true;
    radiance[point ? 1 : 0] = test::renderer().render(request).linear.at(4, 4, 1);
  }
  return radiance[0] / radiance[1];
}

TEST(Spots, light_by_their_closed_form_however_narrow) {
  for (const double outer : {5.0, 1.0, 0.2, 0.05, 0.02, 0.005})
    for (const double place : {0.0, 0.5, 0.75, 0.95, 1.05}) {
      const double inner = 0.5 * outer;
      const auto versine = [](double degrees) {
        const double half = std::sin(0.5 * glm::radians(degrees));
        return 2.0 * half * half;
      };
      const double t = glm::clamp(
          (versine(outer) - versine(place * outer)) / (versine(outer) - versine(inner)), 0.0, 1.0);
      EXPECT_NEAR(share_of_cone(inner, outer, place * outer), t * t * (3.0 - 2.0 * t), 0.02)
          << outer << " degrees at " << place;
    }
}

TEST(FilteredMaps, do_not_hang_on_the_near_plane) {
  Scene scene = gallery();
  for (const char* technique : {"vsm", "savsm", "evsm", "evsm-2", "msm"}) {
    const double before = judge(scene, technique).rms;
    for (const double near : {1e-5, 1e-7}) {
      Scene close = scene;
      close.cameras[0].near_plane = near;
      EXPECT_LT(judge(close, technique).rms, 1.1 * before + 0.005) << technique << ' ' << near;
    }
  }
}

TEST(FilteredMaps, are_the_same_at_every_scale) {
  for (const char* technique : {"vsm", "savsm", "evsm", "evsm-2", "msm"}) {
    const double before = judge(gallery(), technique).rms;
    for (const double scale : {1e-3, 1e3})
      EXPECT_LT(judge(gallery(6.0, scale), technique).rms, 1.1 * before + 0.005)
          << technique << ' ' << scale;
  }
}

TEST(Evsm, holds_with_steep_negative_warps_or_shows_that_it_does_not) {
  const Scene scene = gallery();
  const std::vector<int> truth = test::exact_visibility(scene, {}, width);
  const double before = judge(draw(scene, "evsm", {}, {}, width), truth).rms;
  for (const double c : {20.0, 40.0, 80.0}) {
    const RenderResult result = draw(scene, "evsm", {{"c_negative", c}}, {}, width);
    EXPECT_EQ(result.non_finite_pixels, 0u) << c;
    EXPECT_LT(judge(result, truth).rms, 1.3 * before) << c;
  }
  EXPECT_GT(draw(scene, "evsm", {{"c_negative", 300.0}}, {}, width).non_finite_pixels, 100u);
}

TEST(Maps, keep_the_near_that_was_asked_for_or_fitted) {
  const Scene scene = gallery();
  const ParameterValues deep = {{"depth", std::string("hyperbolic")}, {"far", 1e5}};
  ParameterValues given = deep;
  given["near"] = 1.0;
  const double before = judge(scene, "shadow-map").rms;
  EXPECT_LT(judge(scene, "shadow-map", deep).rms, 2.0 * before);
  EXPECT_LT(judge(scene, "shadow-map", given).rms, 2.0 * before);
  try {
    draw(scene, "shadow-map", {{"far", 1e-300}}, {}, width);
    ADD_FAILURE() << "a far that floats do not hold";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "bad_value");
    EXPECT_EQ(error.field, "far");
  }
}

TEST(SoftVolumes, serve_a_light_that_is_a_line) {
  for (const bool wide : {false, true}) {
    Scene scene = gallery();
    Light& lamp = scene.lights[0];
    lamp.extent.kind = ExtentKind::rectangle;
    lamp.extent.size = wide ? glm::dvec2(0.8, 0.0) : glm::dvec2(0.0, 0.8);
    const RenderResult truth = draw(scene, "reference", {}, {}, width);
    const auto error_of = [&](const char* technique) {
      return tests::visibility_error(draw(scene, technique, {}, {}, width).visibility,
                                     truth.visibility, truth.judged)
          .rms;
    };
    EXPECT_LT(error_of("soft-shadow-volumes"), 0.02);
    EXPECT_GT(error_of("shadow-volumes"), 0.03);
  }
}

TEST(Volumes, counted_before_the_surface_say_where_the_camera_may_be_in_a_shadow) {
  const auto note = testing::Contains(testing::HasSubstr("camera may stand in a shadow"));
  Scene scene = gallery();
  EXPECT_THAT(draw(scene, "shadow-volumes-zpass", {}, {}, width).notes, testing::Not(note));
  scene.cameras[0].position = {0.15, 0.1, -0.2};
  for (const char* technique : {"shadow-volumes-zpass", "shadow-volumes-brute-force"})
    EXPECT_THAT(draw(scene, technique, {}, {}, width).notes, note);
  EXPECT_THAT(draw(scene, "shadow-volumes", {}, {}, width).notes, testing::Not(note));
}

TEST(ReceiverPlanes, are_followed_under_grazing_light) {
  for (const double elevation : {1.0, 0.3, 0.1}) {
    Scene scene = gallery(3.0);
    Light& sun = scene.lights[0];
    sun.kind = LightKind::directional;
    const double angle = glm::radians(elevation);
    sun.direction = {0.6 * std::cos(angle), -std::sin(angle), -0.8 * std::cos(angle)};
    EXPECT_LT(judge(scene, "shadow-map").rms, 0.25) << elevation;
  }
}

TEST(ParallelViews, of_tiny_scenes_keep_their_depth) {
  for (const double scale : {1.0, 1e-5, 1e-7}) {
    Scene scene = gallery(6.0, scale);
    Camera& camera = scene.cameras[0];
    camera.projection = Projection::orthographic;
    camera.orthographic_height = 4.0 * scale;
    EXPECT_LT(judge(scene, "shadow-volumes").wrong, 0.002) << scale;
    EXPECT_LT(judge(scene, "ray-traced").wrong, 0.003) << scale;
  }
}

TEST(Volumes, counted_automatically_are_exact_for_open_meshes) {
  Scene open = gallery();
  // The crate without its lid, one face of the ball turned over.
  for (std::size_t mesh = 0; mesh < open.meshes.size(); ++mesh) {
    Mesh& m = open.meshes[mesh];
    if (mesh == 1) {
      for (std::size_t i = 0; i + 2 < m.indices.size(); i += 3)
        if (m.positions[m.indices[i]].y > 1.0f && m.positions[m.indices[i + 1]].y > 1.0f &&
            m.positions[m.indices[i + 2]].y > 1.0f)
          m.indices[i + 1] = m.indices[i + 2] = m.indices[i];
    } else if (mesh == 2) {
      std::swap(m.indices[200 * 3], m.indices[200 * 3 + 1]);
    }
  }
  const RenderResult behind = draw(open, "shadow-volumes", {}, {}, width);
  const RenderResult automatic =
      draw(open, "shadow-volumes", {{"counting", std::string("automatic")}}, {}, width);
  int different = 0;
  for (std::size_t i = 0; i < behind.visibility.pixels.size(); ++i)
    different += behind.judged.pixels[i] == 1.0f &&
                 behind.visibility.pixels[i] != automatic.visibility.pixels[i];
  EXPECT_LE(different, 3);
}

TEST(Reference, finishes_where_thousands_of_triangles_stand_in_one_shaft) {
  scenes::SceneBuilder b("plates", "Plates");
  const scenes::Look grey = b.look("grey", glm::vec3(0.7f));
  b.ground({-6.0, -6.0}, {6.0, 6.0}, grey);
  scenes::Solid all;
  for (int i = 0; i < 2000; ++i) {
    const double y = 1.0 + 0.00002 * i;
    const scenes::Solid plate = scenes::box({-1.0, y, -1.0}, {1.0, y + 0.00001, 1.0});
    const auto first = static_cast<std::uint32_t>(all.points.size());
    all.points.insert(all.points.end(), plate.points.begin(), plate.points.end());
    for (const auto& t : plate.triangles)
      all.add_triangle(first + t[0], first + t[1], first + t[2]);
  }
  b.place(all, grey, "plates");
  b.spot("lamp", {0.6, 6.0, 0.4}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 40.0, scenes::disc(0.3));
  b.camera("main", {3.2, 3.6, 5.6}, {0.0, 0.4, 0.2}, 45.0);
  const auto resolved = techniques::resolve("reference", {});
  RenderRequest request;
  request.scene = std::make_shared<const Scene>(b.scene);
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.width = request.height = 48;
  request.light_samples = 512;
  request.visibility = true;
  const RenderResult result = test::renderer().render(request);
  int dark = 0, lit = 0;
  for (std::size_t i = 0; i < result.visibility.pixels.size(); ++i) {
    if (result.judged.pixels[i] < 1.0f) continue;
    dark += result.visibility.pixels[i] == 0.0f;
    lit += result.visibility.pixels[i] == 1.0f;
  }
  EXPECT_GT(dark, 40);
  EXPECT_GT(lit, 500);
}

}  // namespace extremes_test
}  // namespace penumbra
