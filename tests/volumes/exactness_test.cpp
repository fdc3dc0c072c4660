// Volumes, and the rays that they are compared with elsewhere, against rays in double precision.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/volumes/drawing.h"
#include "tests/volumes/exact_rays.h"

namespace penumbra {
namespace exactness_test {

using test::draw;
using test::size;

/// Pixels on which both a picture and the truth have something to say.
struct Compared {
  int judged = 0, different = 0;
  double share() const { return static_cast<double>(different) / judged; }
};

Compared compare(const RenderResult& result, const std::vector<int>& truth) {
  Compared compared;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // Samples that face the light by their facet but not by their smooth normal, or the other way
    // round, get none whatever the technique says: the shading terminator is no one's error.
    if (result.judged.pixels[i] < 1.0f || truth[i] < 0) continue;
    ++compared.judged;
    compared.different += result.visibility.pixels[i] != static_cast<float>(truth[i]);
  }
  return compared;
}

Compared compare(const RenderResult& a, const RenderResult& b) {
  Compared compared;
  for (std::size_t i = 0; i < a.judged.pixels.size(); ++i) {
    if (a.judged.pixels[i] < 1.0f) continue;
    ++compared.judged;
    compared.different += a.visibility.pixels[i] != b.visibility.pixels[i];
  }
  return compared;
}

struct Case {
  const char* scene;
  bool camera_in_volume;  ///< z-pass is wrong there
};

class EveryScene : public testing::TestWithParam<Case> {};

TEST_P(EveryScene, has_exact_shadows_by_volumes_and_by_rays_on_the_device) {
  const Scene scene = *scenes::load(GetParam().scene);
  const std::vector<int> truth = test::exact_visibility(scene, {}, size);
  const RenderResult rays = draw(scene, "ray-traced", {{"rays", std::int64_t{1}}});
  const Compared traced = compare(rays, truth);
  EXPECT_GT(traced.judged, 5000);
  EXPECT_LT(traced.share(), 0.0005) << traced.different;
  for (const char* technique :
       {"shadow-volumes", "shadow-volumes-zpass-plus", "shadow-volumes-zpass"}) {
    if (GetParam().camera_in_volume && technique == std::string("shadow-volumes-zpass")) continue;
    const RenderResult volumes = draw(scene, technique);
    const Compared exact = compare(volumes, truth);
    EXPECT_LT(exact.share(), 0.0002) << technique << ' ' << exact.different;
    const Compared alike = compare(volumes, rays);
    EXPECT_LT(alike.share(), 0.0005) << technique << ' ' << alike.different << " unlike rays";
  }
}

INSTANTIATE_TEST_SUITE_P(Of, EveryScene,
                         testing::Values(Case{"boxes", false}, Case{"disco-box", false},
                                         Case{"car", false}, Case{"island", false},
                                         Case{"warehouse-inside", false},
                                         Case{"warehouse-outside", false}, Case{"half-plane", true},
                                         Case{"three-layers", false}, Case{"contact", false},
                                         Case{"leaky-box", true}, Case{"camera-in-volume", true},
                                         Case{"aircraft", false}, Case{"teapot", false},
                                         Case{"sweep:9x800x2", false}));

/// Hills, an open mesh of `cells` by `cells` squares in 6 m by 6 m.
Scene hills(std::uint32_t cells) {
  scenes::SceneBuilder b("hills", "Hills");
  scenes::Solid field;
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const double x = 6.0 * i / cells - 3.0;
      const double z = 6.0 * j / cells - 3.0;
      const double y = 0.35 * std::sin(2.1 * x) * std::cos(1.7 * z + 0.3);
      field.points.push_back({x, y + 0.05 * std::sin(9.0 * x + 3.0 * z), z});
    }
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i;
      const std::uint32_t c = a + cells + 1;
      field.triangles.push_back({a, c, a + 1});
      field.triangles.push_back({a + 1, c, c + 1});
    }
  b.place(field, b.look("grey", glm::vec3(0.7f)), "field");
  b.spot("lamp", {2.5, 1.3, 1.0}, {0.0, 0.0, 0.0}, glm::vec3(1.0f), 1.0f, 60.0, LightExtent{});
  b.camera("main", {0.0, 3.0, 4.5}, {0.0, 0.0, 0.0}, 50.0);
  return b.scene;
}

TEST(ShadowVolumes, of_open_hills_leave_no_specks_where_caps_lie_in_lit_surfaces) {
  // Squares of 4 pixels, and of half a pixel.
  for (const std::uint32_t cells : {30u, 300u}) {
    const Scene scene = hills(cells);
    const std::vector<int> truth = test::exact_visibility(scene, {}, size);
    EXPECT_GT(std::count(truth.begin(), truth.end(), 0), 1000);
    EXPECT_GT(std::count(truth.begin(), truth.end(), 1), 8000);
    for (const bool clamp : {false, true}) {
      const Compared exact = compare(draw(scene, "shadow-volumes", {{"clamp", clamp}}), truth);
      EXPECT_LE(exact.different, 1) << cells << " cells, clamp " << clamp;
    }
  }
}

TEST(ShadowVolumes, of_open_hills_that_the_near_plane_cuts_leave_no_specks) {
  Scene scene = hills(60);
  for (Material& material : scene.materials) material.double_sided = true;
  Camera& camera = scene.cameras[0];
  camera.position = {0.4, 0.3, 1.0};
  camera.target = {0.0, 0.0, 0.0};
  camera.orthographic_height = 3.0;
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    camera.projection = projection;
    const std::vector<int> truth = test::exact_visibility(scene, {}, size);
    EXPECT_GT(std::count(truth.begin(), truth.end(), 1), 4000);
    EXPECT_LE(compare(draw(scene, "shadow-volumes"), truth).different, 2);
  }
}

TEST(ShadowVolumes, counted_in_one_pass_and_in_two_differ_at_most_by_slivers) {
  // A driver that culls clipped triangles before it moves their corners onto the grid of the
  // rasteriser drops slivers which that turns over; with a two-sided stencil they count.
  for (const char* id : {"teapot", "warehouse-outside"}) {
    const Scene scene = *scenes::load(id);
    const RenderResult one = draw(scene, "shadow-volumes");
    const RenderResult two = draw(scene, "shadow-volumes", {{"stencil_passes", std::int64_t{2}}});
    EXPECT_LE(compare(one, two).different, 2) << id;
  }
}

}  // namespace exactness_test
}  // namespace penumbra
