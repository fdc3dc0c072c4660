#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <sstream>

#include "scenes/import/import.h"
#include "scenes/import/polygon.h"
#include "scenes/library.h"
#include "scenes/picture_io.h"
#include "tests/scenes/gltf_file.h"

namespace penumbra::scenes {
namespace {

using test::error_of;
using test::TemporaryFolder;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

using Polygon = std::vector<glm::dvec2>;

Scene obj(const std::string& text) {
  const TemporaryFolder folder;
  return import_obj(folder.write("model.obj", text), false);
}

/// Corners of all triangles in world space.
std::vector<glm::dvec3> corners_of(const Scene& scene) {
  std::vector<glm::dvec3> corners;
  for (const Instance& instance : scene.instances)
    for (const std::uint32_t index : scene.meshes[instance.mesh].indices)
      corners.emplace_back(
          instance.world_from_object *
          glm::dvec4(glm::dvec3(scene.meshes[instance.mesh].positions[index]), 1.0));
  return corners;
}

/// Twice the signed area in the plane.
double cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double area(const Polygon& polygon) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    sum += 0.5 * (a.x * b.y - a.y * b.x);
  }
  return sum;
}

/// By the number of edges that a ray to the right crosses.
bool inside(const Polygon& polygon, const glm::dvec2& point) {
  bool odd = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.y > point.y) != (b.y > point.y) &&
        point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x))
      odd = !odd;
  }
  return odd;
}

double distance_to_border(const Polygon& polygon, const glm::dvec2& point) {
  double least = 1e300;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i], edge = polygon[(i + 1) % polygon.size()] - a;
    const double length = glm::dot(edge, edge);
    const double t = length > 0.0 ? std::clamp(glm::dot(point - a, edge) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, glm::distance(point, a + t * edge));
  }
  return least;
}

/// Triangulates the polygon in a plane of space, turned by two angles, and judges what comes out in
/// the polygon's own plane: each point inside lies in one triangle, each outside in none, and all
/// triangles face as the polygon does.
void judge(const Polygon& polygon, double turn, double tilt) {
  const glm::dvec3 right(std::cos(turn), 0.0, std::sin(turn));
  const glm::dvec3 up(-std::sin(turn) * std::sin(tilt), std::cos(tilt),
                      std::cos(turn) * std::sin(tilt));
  std::ostringstream text;
  text.precision(17);
  for (const glm::dvec2& point : polygon) {
    const glm::dvec3 place = point.x * right + point.y * up;
    text << "v " << place.x << " " << place.y << " " << place.z << "\n";
  }
  text << "f";
  for (std::size_t i = 0; i < polygon.size(); ++i) text << " " << i + 1;
  const std::vector<glm::dvec3> corners = corners_of(obj(text.str()));
  ASSERT_GT(corners.size(), 0u);
  Polygon flat;
  for (const glm::dvec3& corner : corners)
    flat.emplace_back(glm::dot(corner, right), glm::dot(corner, up));
  double sum = 0.0, absolute = 0.0;
  for (std::size_t i = 0; i < flat.size(); i += 3) {
    const double twice = cross(flat[i], flat[i + 1], flat[i + 2]);
    sum += 0.5 * twice;
    absolute += 0.5 * std::abs(twice);
  }
  const double size = std::abs(area(polygon));
  EXPECT_NEAR(sum, area(polygon), 1e-5 * size);
  EXPECT_NEAR(absolute, size, 1e-5 * size) << "triangles that overlap or look away";
  glm::dvec2 low(1e300), high(-1e300);
  for (const glm::dvec2& point : polygon) low = glm::min(low, point), high = glm::max(high, point);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-0.05, 1.05);
  for (int k = 0; k < 400; ++k) {
    const glm::dvec2 point = low + glm::dvec2(unit(random), unit(random)) * (high - low);
    if (distance_to_border(polygon, point) < 1e-4 * glm::length(high - low)) continue;
    int covers = 0;
    for (std::size_t i = 0; i < flat.size(); i += 3)
      covers += inside({flat[i], flat[i + 1], flat[i + 2]}, point);
    ASSERT_EQ(covers, inside(polygon, point)) << point.x << ", " << point.y;
  }
}

TEST(Polygons, AreWhatTheFileSays) {
  const std::vector<Polygon> polygons = {
      {{0, 0}, {2, 0}, {2, .5}, {.5, .5}, {.5, 1.5}, {2, 1.5}, {2, 2}, {0, 2}},  // the letter C
      {{0, 0}, {1, .6}, {2, 0}, {1, 2}},                                         // a dart
      {{1, .6}, {2, 0}, {1, 2}, {0, 0}},                                         // turned
      {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}},  // a hole
      {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {0, 2}, {0, 1}},  // corners on lines
      {{0, 0}, {0, 0}, {4, 0}, {4, 3}, {4, 3}, {4, 3}, {0, 3}, {0, 0}},  // corners twice
      {{0, 0}, {10, 0}, {10, .01}, {.01, .01}, {.01, 10}, {0, 10}},      // thin
      {{0, 0},
       {4, 0},
       {4, 4},
       {3, 4},
       {3, 1},
       {2.5, 4},
       {2, 1},
       {1.5, 4},
       {1, 1},
       {0, 4}}};  // comb
  for (std::size_t i = 0; i < polygons.size(); ++i)
    for (const double turn : {0.0, 0.7})
      for (const double tilt : {0.0, 1.2, std::numbers::pi / 2}) {
        SCOPED_TRACE(testing::Message() << "polygon " << i << ", " << turn << ", " << tilt);
        judge(polygons[i], turn, tilt);
        judge({polygons[i].rbegin(), polygons[i].rend()}, turn, tilt);
      }
}

TEST(Polygons, OfManyCornersAreWhatTheFileSays) {
  std::mt19937 random(20071122);
  std::uniform_real_distribution<double> radius(0.3, 1.0);
  for (const int corners : {5, 17, 64, 300, 1000}) {
    Polygon star;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / corners;
      star.push_back(radius(random) * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    SCOPED_TRACE(corners);
    judge(star, 0.4, 0.9);
  }
}

TEST(Polygons, WithTwoHolesKeepThem) {
  Polygon plate{{0, 0}, {7, 0}, {7, 3}, {0, 3}, {0, 0}};
  for (const double x : {1.0, 4.0})
    for (const glm::dvec2& corner : Polygon{{0, 1}, {0, 2}, {2, 2}, {2, 1}, {0, 1}})
      plate.push_back(corner + glm::dvec2(x, 0));
  plate.push_back({1, 1});  // back by the way it came
  judge(plate, 0.3, 0.4);
}

TEST(Polygons, BentQuadsKeepTheirFourCorners) {
  const Scene scene = obj("v 0 0 0\nv 1 0 0.2\nv 1 1 0\nv 0 1 0.3\nf 1 2 3 4\n");
  EXPECT_EQ(scene.meshes[0].indices.size(), 6u);
  double most = 0.0;
  for (const glm::dvec3& corner : corners_of(scene)) most = std::max(most, corner.z);
  EXPECT_FLOAT_EQ(static_cast<float>(most), 0.3f);
}

TEST(Polygons, ThatCrossThemselvesKeepTheirPartsAndANoteSaysSo) {
  // A bow tie of two triangles of area 1 each, and a corner added where they meet.
  const Scene scene = obj("v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\nf 1 2 3 4\n");
  const std::vector<glm::dvec3> corners = corners_of(scene);
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); i += 3)
    sum += 0.5 * glm::length(glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]));
  EXPECT_NEAR(sum, 2.0, 1e-6);
  EXPECT_THAT(corners, Contains(glm::dvec3(1, 1, 0)));
  EXPECT_THAT(scene.notes, Contains(HasSubstr("edges cross")));
}

TEST(Polygons, OfRandomCornersNeverCrash) {
  std::mt19937 random(11);
  for (int round = 0; round < 2000; ++round) {
    std::vector<glm::dvec3> polygon(3 + random() % 12);
    for (glm::dvec3& corner : polygon)
      corner = {random() % 4, random() % 4, round % 3 == 0 ? random() % 4 : 0};
    std::size_t added = 0;
    const Triangulation result = triangulate(polygon, [&](const CornerShares& shares) {
      double sum = 0.0;
      for (const auto& [corner, share] : shares) {
        EXPECT_LT(corner, polygon.size() + added);
        sum += share;
      }
      EXPECT_NEAR(sum, 1.0, 1e-5);
      ++added;
    });
    EXPECT_EQ(result.corners.size() % 3, 0u);
    for (const std::uint32_t corner : result.corners) EXPECT_LT(corner, polygon.size() + added);
  }
}

const std::string box_corners =
    "v -0.5 0 -0.5\nv -0.5 0 0.5\nv -0.5 1 -0.5\nv -0.5 1 0.5\n"
    "v 0.5 0 -0.5\nv 0.5 0 0.5\nv 0.5 1 -0.5\nv 0.5 1 0.5\n";
const std::string box_faces = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

TEST(Obj, ReadsWhatPeoplesToolsWrite) {
  const std::vector<glm::dvec3> box = corners_of(obj(box_corners + box_faces));
  ASSERT_EQ(box.size(), 36u);
  const std::string whole = box_corners + box_faces;
  for (const std::string& text :
       {"\xef\xbb\xbf" + whole, replaced(whole, "\n", "\r\n"), replaced(whole, "\n", "\r"),
        replaced(whole, "f 1 2 ", "f 1 \\\n 2 \\\r\n"), replaced(whole, "8 6", "8\\\n6"),
        replaced(whole, "0.5", "0,5"), replaced(whole, "0.5", "+.5E+0"),
        replaced(whole, "0.5\n", "0.5 # corner \\\n"), replaced(whole, "-+", "-"),
        replaced(whole, " ", "\t "), "# f 1 2 9999\n" + whole + "# the end",
        replaced(whole, "\nf 1 2", "\n  f -8 -7"), replaced(whole, "f ", "f\t"),
        replaced(whole, " 3\n", " 3/ \n"), replaced(whole, " 3\n", " 3//\n"),
        "vt 0 0\nvt 1 1 0\n" + replaced(whole, "f 1 2 ", "f 1/1/ 2/2/ "),
        "vt 0 0\n" + replaced(whole, "f 1 2 ", "f 1/1 2/-1 "),
        "s off\no box\nlod 3\nvp 1 2\nl 1 2\np 1\n" + whole,
        replaced(whole, "-+", "+").substr(0, whole.size() - 1)}) {
    if (text.find("-+") != std::string::npos) continue;
    EXPECT_EQ(corners_of(obj(text)), box) << text;
  }
}

TEST(Obj, RefusesNumbersThatAreNoneAndNamesTheLine) {
  for (const char* bad : {"nan", "-nan", "inf", "-inf", "1e999", "1.#QNAN", "abc", "1.0.0", "1,2,3",
                          "0x10", "--1", "1.5f"})
    EXPECT_THAT(error_of([&] {
                  obj("# first\nv 0 0 0\nv 1 0 " + std::string(bad) + "\nv 0 1 0\nf 1 2 3\n");
                }),
                AllOf(HasSubstr("unreadable: line 3: '"), HasSubstr(bad)));
  EXPECT_THAT(error_of([] { obj("v 0 0\nf 1 1 1"); }), HasSubstr("line 1: v needs 3 numbers"));
  EXPECT_THAT(error_of([] { obj("v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 4\n"); }),
              HasSubstr("line 5: a face has the vertex '4' of 3"));
  for (const char* bad : {"0", "-4", "99999999999999999999", "x", "1.5", "/1"})
    EXPECT_THAT(
        error_of([&] { obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 " + std::string(bad) + "\n"); }),
        HasSubstr("unreadable: line 4: "))
        << bad;
  EXPECT_THAT(error_of([] { obj("v 1e16 0 0\n"); }), HasSubstr("line 1: '1e16' is beyond"));
  EXPECT_THAT(error_of([] { obj(std::string("\xff\xfe") + "v\0 \0"); }), HasSubstr("UTF-16"));
  EXPECT_LT(error_of([] { obj("v 0 0 " + std::string(5000000, 'x')); }).size(), 300u);
}

TEST(Obj, KeepsGeoreferencedCoordinatesToTheMillimetre) {
  // A ring of a metre around a place of UTM, another far from it, and a stray point at the origin.
  std::ostringstream text;
  text.precision(17);
  std::vector<glm::dvec3> ring;
  for (const glm::dvec3& center :
       {glm::dvec3(512345.25, 120.8, -5412345.75), glm::dvec3(-3.8e8, 0.1, 7.0)}) {
    text << "o ring\n";
    for (int i = 0; i < 64; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 64;
      ring.push_back(center + glm::dvec3(std::cos(angle), 0.0, -std::sin(angle)));
      text << "v " << ring.back().x << " " << ring.back().y << " " << ring.back().z << "\n";
    }
    text << "f";
    for (int i = -64; i < 0; ++i) text << " " << i;
    text << "\n";
  }
  text << "v 0 0 0\nf 1 2 -1\n";
  const Scene scene = obj(text.str());
  std::vector<double> nearest(ring.size(), 1e300);
  for (const glm::dvec3& corner : corners_of(scene))
    for (std::size_t i = 0; i < ring.size(); ++i)
      nearest[i] = std::min(nearest[i], glm::distance(corner, ring[i]));
  for (std::size_t i = 0; i < ring.size(); ++i) EXPECT_LT(nearest[i], 1e-5) << i;
  EXPECT_THAT(scene.notes, Contains(HasSubstr("counted from (5")));
  // Near the origin coordinates stay as they are written.
  EXPECT_EQ(obj(box_corners + box_faces).instances[0].world_from_object, glm::dmat4(1.0));
}

TEST(Obj, LeavesUnusableSideFilesOutWithANote) {
  const TemporaryFolder folder;
  folder.write("secret.png", encode_png(Image8(1, 1, 4, 9)));
  folder.write("scene/fake.bmp", "BM no picture");
  folder.write("scene/tex/good one+1.png", encode_png(Image8(2, 2, 4, 77)));
  const auto model = [&](const std::string& library, const std::string& materials) {
    folder.write("scene/m.mtl", materials);
    return import_obj(folder.write("scene/m.obj", "mtllib " + library + "\n" + box_corners +
                                                      "usemtl m\n" + box_faces),
                      false);
  };
  for (const std::string name :
       {"C:\\Users\\me\\c.png", "../secret.png", "..\\secret.png", "/etc/passwd", "fake.bmp",
        "http://127.0.0.1:1/x.png", "missing.png", "%2e%2e/secret.png", "tex"}) {
    const Scene scene = model("m.mtl", "newmtl m\nKd 1 1 1\nmap_Kd " + name + "\n");
    EXPECT_EQ(corners_of(scene).size(), 36u) << name;
    EXPECT_TRUE(scene.textures.empty()) << name;
    EXPECT_THAT(scene.notes, Contains(AllOf(HasSubstr("map_Kd"), HasSubstr("left out")))) << name;
  }
  for (const std::string library : {"C:\\models\\x.mtl", "../x.mtl", "missing one.mtl", "/x.mtl"})
    EXPECT_THAT(model(library, "").notes,
                Contains(AllOf(HasSubstr("mtllib"), HasSubstr("left out"))))
        << library;
  // Names with spaces, pluses, percents and backslashes are found.
  for (const std::string name :
       {"tex/good one+1.png", "tex\\good one+1.png", "tex/good%20one+1.png"})
    EXPECT_EQ(model("m.mtl", "newmtl m\nmap_Kd " + name + "\n").textures.size(), 1u) << name;
  const Scene odd = model("m.mtl", "newmtl m # red\nKd 0,8 0,1 nan\n");
  EXPECT_THAT(odd.notes, Contains(AllOf(HasSubstr("line 2: 'nan'"), HasSubstr("left out"))));
  const Scene comma = model("m.mtl", "newmtl m # red\nKd 0,8 0,25 \\\n 0 # note\n");
  EXPECT_EQ(comma.materials[0].base_color, glm::vec3(0.8f, 0.25f, 0.0f));
}

TEST(Obj, ReadsColoursOfVerticesFromZeroToOneAndTo255) {
  for (const char* one : {"1", "255"}) {
    const std::string top = one;
    const Scene scene = obj("v 0 0 0\nv 1 0 0 " + top + " 0 0\nv 0 1 0 0 " + top + " 0\nf 1 2 3\n");
    EXPECT_EQ(scene.meshes[0].colors,
              (std::vector<glm::vec4>{{1, 1, 1, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}}));
  }
}

TEST(Obj, LeavesFacesOfTooManyCornersOut) {
  std::string face = "f";
  for (int i = 0; i < 200'000; ++i) face += " 1 2 3";
  const Scene scene = obj(box_corners + face + "\n" + box_faces);
  EXPECT_EQ(corners_of(scene).size(), 36u);
  EXPECT_THAT(scene.notes, Contains(HasSubstr("more than 10000 corners")));
}

TEST(Obj, TellsWhatItCannotDraw) {
  const TemporaryFolder folder;
  folder.write("m.mtl", "newmtl m\nd 0.3\nmap_Bump b.png\nmap_d a.png\n");
  const auto file = folder.write("m.obj", "mtllib m.mtl\n" + box_corners +
                                              "l 1 2\nl 2 3\ncurv 0 1 1 2\nusemtl m\n" + box_faces +
                                              "usemtl other\n" + box_faces);
  EXPECT_THAT(import_obj(file, false).notes,
              AllOf(Contains(HasSubstr("line 10 is a line: it is left out (and 1 more like it)")),
                    Contains(HasSubstr("'curv' is left out")), Contains(HasSubstr("transparent")),
                    Contains(HasSubstr("bump")), Contains(HasSubstr("map_d")),
                    Contains(HasSubstr("'other' is in no material file"))));
}

}  // namespace
}  // namespace penumbra::scenes
