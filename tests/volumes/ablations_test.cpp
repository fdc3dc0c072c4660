// What shadow volumes take precautions against, shown by leaving each out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/volumes/drawing.h"
#include "tests/volumes/exact_rays.h"

namespace penumbra {
namespace {

using test::draw;
using test::size;

RenderResult without(const char* precaution, const Scene& scene) {
  return draw(scene, "shadow-volumes", {{"ablation", std::string(precaution)}});
}

struct Pixel {
  std::uint32_t x, y;
};

/// Pixels of a picture of one light that are wrong.
std::vector<Pixel> wrong_pixels(const RenderResult& result, const std::vector<int>& truth) {
  std::vector<Pixel> wrong;
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const int exact = truth[std::size_t{y} * size + x];
      if (result.judged.at(x, y, 0) == 1.0f && exact >= 0 &&
          result.visibility.at(x, y, 0) != static_cast<float>(exact))
        wrong.push_back({x, y});
    }
  return wrong;
}

const glm::dvec3 box_low(-0.4, 0.5, -0.3);
const glm::dvec3 box_high(0.5, 0.9, 0.4);

/// A box over the ground.
Scene floating_box() {
  scenes::SceneBuilder b("floating-box", "A box over the ground");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-3.0, -3.0}, {3.0, 3.0}, look);
  b.place(scenes::box(box_low, box_high), look, "box");
  b.spot("lamp", {1.1, 3.0, 0.7}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 60.0, LightExtent{});
  b.camera("main", {2.0, 2.6, 3.4}, {-0.2, 0.2, -0.1}, 50.0);
  return b.scene;
}

TEST(ZFail, needs_volumes_that_no_far_plane_cuts) {
  const Scene scene = floating_box();
  const std::vector<int> truth = test::exact_visibility(scene, {}, size);
  const auto shadowed = static_cast<std::size_t>(std::count(truth.begin(), truth.end(), 0));
  EXPECT_GT(shadowed, 500u);
  EXPECT_THAT(wrong_pixels(without("none", scene), truth), testing::SizeIs(0));
  EXPECT_GT(wrong_pixels(without("far-clipped", scene), truth).size(), shadowed / 2);
}

TEST(ZFail, needs_caps) {
  const Scene scene = floating_box();
  const std::vector<int> truth = test::exact_visibility(scene, {}, size);
  const auto shadowed = static_cast<std::size_t>(std::count(truth.begin(), truth.end(), 0));
  EXPECT_GT(wrong_pixels(without("uncapped", scene), truth).size(), shadowed / 2);
}

/// The floating box without the face that looks away from the light, onto the ground.
Scene box_without_bottom() {
  Scene scene = floating_box();
  Mesh& mesh = scene.meshes[scene.instances[1].mesh];
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    double highest = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      highest = std::max(highest, static_cast<double>(mesh.positions[mesh.indices[i + k]].y));
    if (highest > box_low.y + 0.01)
      kept.insert(kept.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(i),
                  mesh.indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
  }
  EXPECT_EQ(kept.size() + 6, mesh.indices.size());
  mesh.indices = kept;
  mesh.primitives.front().index_count = static_cast<std::uint32_t>(kept.size());
  return scene;
}

/// Whether light that reached a point would come through the hole, widened by `margin` metres.
bool through_hole(const Scene& scene, const glm::dvec3& point, double margin) {
  const glm::dvec3 light = scene.lights[0].position;
  const glm::dvec3 at = light + (point - light) * (light.y - box_low.y) / (light.y - point.y);
  return point.y < box_low.y + margin && at.x > box_low.x - margin && at.x < box_high.x + margin &&
         at.z > box_low.z - margin && at.z < box_high.z + margin;
}

TEST(Gaps, leak_through_silhouettes_that_take_meshes_for_closed) {
  const Scene scene = box_without_bottom();
  const std::vector<int> truth = test::exact_visibility(scene, {}, size);
  EXPECT_THAT(wrong_pixels(without("none", scene), truth), testing::SizeIs(0))
      << "gaps are silhouettes otherwise";
  const std::vector<Pixel> wrong = wrong_pixels(without("gaps-ignored", scene), truth);
  EXPECT_GT(wrong.size(), 500u);
  // What is missing is the shadow of the hole, so only views into it can be wrong.
  int outside = 0;
  for (const Pixel& pixel : wrong) {
    const test::Ray view = test::camera_ray(scene.cameras[0], pixel.x, pixel.y, size);
    bool inside = false;
    for (double t = 0.01; t < 100.0 && !inside; t *= 1.002)
      inside = through_hole(scene, view.from + t * view.along, 0.01);
    outside += !inside;
  }
  EXPECT_EQ(outside, 0) << "of " << wrong.size();
}

TEST(Gaps, leak_through_maps_of_back_faces) {
  const Scene scene = box_without_bottom();
  const std::vector<int> truth = test::exact_visibility(scene, {}, size);
  const std::vector<Pixel> front = wrong_pixels(draw(scene, "shadow-map"), truth);
  const std::vector<Pixel> back = wrong_pixels(draw(scene, "shadow-map-back-faces"), truth);
  const auto in_the_leak = [&](const std::vector<Pixel>& wrong) {
    return std::count_if(wrong.begin(), wrong.end(), [&](const Pixel& pixel) {
      return through_hole(scene, test::ground_point(scene.cameras[0], pixel.x, pixel.y), 0.02);
    });
  };
  EXPECT_GT(in_the_leak(back), 300);
  EXPECT_GT(in_the_leak(back), 10 * in_the_leak(front));
  const auto elsewhere = static_cast<std::ptrdiff_t>(back.size()) - in_the_leak(back);
  EXPECT_LT(10 * elsewhere, in_the_leak(back));
}

/// A thin plate of many triangles, turned anyhow, and a light close to it in the very plane of its
/// upper side: rounding decides which way each triangle looks.
Scene plate_edge_on() {
  scenes::SceneBuilder b("plate", "A plate edge-on to a light");
  const scenes::Look look = b.look("grey", glm::vec3(0.7f));
  b.ground({-4.0, -4.0}, {4.0, 4.0}, look);
  scenes::Solid plate;
  constexpr std::uint32_t cells = 16;
  constexpr std::uint32_t row = cells + 1;
  for (const double y : {0.0, -0.05})
    for (std::uint32_t j = 0; j < row; ++j)
      for (std::uint32_t i = 0; i < row; ++i)
        plate.points.push_back({2.0 * i / cells - 1.0, y, 2.0 * j / cells - 1.0});
  const auto quad = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
    plate.triangles.push_back({p, q, r});
    plate.triangles.push_back({p, r, s});
  };
  constexpr std::uint32_t under = row * row;
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * row + i;
      quad(a, a + row, a + row + 1, a + 1);
      quad(under + a, under + a + 1, under + a + row + 1, under + a + row);
    }
  for (std::uint32_t i = 0; i < cells; ++i) {
    quad(i, i + 1, under + i + 1, under + i);
    const std::uint32_t far = cells * row + i;
    quad(far + 1, far, under + far, under + far + 1);
    quad((i + 1) * row, i * row, under + i * row, under + (i + 1) * row);
    const std::uint32_t right = i * row + cells;
    quad(right, right + row, under + right + row, under + right);
  }
  const glm::dmat4 turned =
      glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 1.5, 0.0)) *
      glm::rotate(glm::dmat4(1.0), 0.9, glm::normalize(glm::dvec3(0.3, 0.2, 1.0)));
  b.place(plate, look, "plate", turned);
  const glm::dvec3 light(turned * glm::dvec4(1.3, 0.0, 0.17, 1.0));
  b.spot("lamp", light, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 75.0, LightExtent{});
  b.camera("main", {0.5, 4.0, 5.0}, {0.0, 0.4, 0.0}, 60.0);
  return b.scene;
}

TEST(Silhouettes, need_one_answer_for_each_triangle_on_whether_it_is_lit) {
  const Scene scene = plate_edge_on();
  const std::vector<int> truth = test::exact_visibility(scene, {}, size);
  EXPECT_GT(std::count(truth.begin(), truth.end(), 1), 5000);
  EXPECT_LE(wrong_pixels(without("none", scene), truth).size(), 2u);
  EXPECT_GT(wrong_pixels(without("first-corner", scene), truth).size(), 100u);
}

}  // namespace
}  // namespace penumbra
