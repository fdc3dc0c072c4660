#include "scenes/document_meshes.h"

#include <cmath>
#include <map>

#include "scenes/generators/shapes.h"
#include "scenes/import/local_origin.h"
#include "scenes/json_reader.h"

namespace penumbra::scenes {
namespace {

using nlohmann::json;

double positive(JsonReader& reader, const char* key, double otherwise) {
  reader.number(key, otherwise, 1e-6, 1e6);
  return otherwise;
}

int steps(JsonReader& reader, const char* key, int otherwise, int low = 3) {
  std::int64_t count = otherwise;
  reader.integer(key, count, low, 512);
  return static_cast<int>(count);
}

void read_corners(JsonReader& reader, glm::dvec3& low, glm::dvec3& high) {
  low = {-0.5, 0.0, -0.5};
  high = {0.5, 1.0, 0.5};
  reader.vector("low", low, -1e6, 1e6);
  reader.vector("high", high, -1e6, 1e6);
  for (int c = 0; c < 3; ++c)
    if (!(high[c] > low[c])) reader.fail("high", "must be above low along every axis");
}

/// Rows of `width` numbers each.
std::vector<std::vector<double>> read_rows(JsonReader& reader, const char* key, std::size_t width,
                                           std::size_t least) {
  std::vector<std::vector<double>> rows;
  const json& list = reader.at(key);
  if (!list.is_array() || list.size() < least || list.size() > 512)
    reader.fail(key, "must be a list of " + std::to_string(least) + " to 512 points");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string path = reader.path_of(key) + "[" + std::to_string(i) + "]";
    rows.push_back(read_numbers(list[i], path, -1e6, 1e6));
    if (rows.back().size() != width)
      throw unreadable(path + " must have " + std::to_string(width) + " numbers", path);
  }
  return rows;
}

Solid make_box(JsonReader& reader) {
  glm::dvec3 low, high;
  read_corners(reader, low, high);
  return box(low, high);
}

Solid make_rounded_box(JsonReader& reader) {
  glm::dvec3 low, high;
  read_corners(reader, low, high);
  const double radius = positive(reader, "radius", 0.05);
  const glm::dvec3 size = high - low;
  if (2.0 * radius >= std::min({size.x, size.y, size.z}))
    reader.fail("radius", "must be less than half of every side");
  const int segments = steps(reader, "segments", 2, 1);
  if (segments > 32) reader.fail("segments", "must be in 1..32");
  return rounded_box(low, high, radius, segments);
}

Solid make_lathe(JsonReader& reader) {
  std::vector<glm::dvec2> profile;
  for (const auto& row : read_rows(reader, "profile", 2, 2)) {
    const bool end = profile.empty() || profile.size() + 1 == reader.at("profile").size();
    if (row[0] < 0.0 || (row[0] == 0.0 && !end))
      reader.fail("profile", "must have radii above 0 between its ends");
    profile.emplace_back(row[0], row[1]);
  }
  return lathe(profile, steps(reader, "slices", 32));
}

Solid make_extrusion(JsonReader& reader) {
  std::vector<glm::dvec2> polygon;
  for (const auto& row : read_rows(reader, "polygon", 2, 3)) polygon.emplace_back(row[0], row[1]);
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    area += a.x * b.y - a.y * b.x;
  }
  if (!(area > 0.0)) reader.fail("polygon", "must run counter-clockwise");
  return extrude(polygon, positive(reader, "depth", 1.0));
}

Solid make_tube(JsonReader& reader) {
  std::vector<glm::dvec3> path;
  for (const auto& row : read_rows(reader, "path", 3, 2)) path.emplace_back(row[0], row[1], row[2]);
  for (std::size_t i = 1; i < path.size(); ++i)
    if (path[i] == path[i - 1]) reader.fail("path", "must not stay at a point");
  return tube(path, std::vector<double>(path.size(), positive(reader, "radius", 0.05)),
              steps(reader, "sides", 12));
}

using Maker = Solid (*)(JsonReader&);

const std::map<std::string, Maker>& makers() {
  static const std::map<std::string, Maker> table = {
      {"box", make_box},
      {"rounded_box", make_rounded_box},
      {"lathe", make_lathe},
      {"extrusion", make_extrusion},
      {"tube", make_tube},
      {"sphere",
       [](JsonReader& r) {
         return sphere(positive(r, "radius", 0.5), steps(r, "slices", 48), steps(r, "stacks", 24));
       }},
      {"cylinder",
       [](JsonReader& r) {
         double top = 0.5;
         r.number("radius_high", top, 0.0, 1e6);
         return cylinder(positive(r, "radius_low", 0.5), top, positive(r, "height", 1.0),
                         steps(r, "slices", 48));
       }},
      {"torus",
       [](JsonReader& r) {
         const double radius = positive(r, "radius", 0.4), tube_radius = positive(r, "tube", 0.1);
         if (tube_radius >= radius) r.fail("tube", "must be less than radius");
         return torus(radius, tube_radius, steps(r, "slices", 48), steps(r, "sides", 24));
       }},
      {"trefoil",
       [](JsonReader& r) {
         return trefoil(positive(r, "tube", 0.13), steps(r, "steps", 50, 12),
                        steps(r, "sides", 16));
       }},
      {"boulder", [](JsonReader& r) {
         std::int64_t seed = 1;
         double roughness = 0.6;
         r.integer("seed", seed, 0, 0xffffffff);
         r.number("roughness", roughness, 0.0, 0.9);
         return boulder(static_cast<std::uint32_t>(seed), roughness, steps(r, "slices", 24),
                        steps(r, "stacks", 16));
       }}};
  return table;
}

template <int N>
void read_array(JsonReader& reader, const char* key, double bound,
                std::vector<glm::vec<N, float>>& out) {
  if (!reader.has(key)) return;
  const auto numbers = read_numbers(reader.at(key), reader.path_of(key), -bound, bound);
  if (numbers.size() % N != 0)
    reader.fail(key, "must have " + std::to_string(N) + " numbers per vertex");
  out.resize(numbers.size() / N);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out[i / N][static_cast<int>(i % N)] = static_cast<float>(numbers[i]);
}

/// Positions, counted from a place near them where they are to fit into floats. Those that are
/// floats stay as they are, so that a written scene reads back the same.
void read_positions(JsonReader& reader, std::vector<glm::vec3>& positions, glm::dvec3& origin) {
  read_array<3>(reader, "positions", max_coordinate, positions);
  const json& numbers = reader.at("positions");
  std::vector<glm::dvec3> points(positions.size());
  bool exact = true;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const int axis = static_cast<int>(i % 3);
    points[i / 3][axis] = numbers[i].get<double>();
    exact = exact && points[i / 3][axis] == static_cast<double>(positions[i / 3][axis]);
  }
  if (exact) return;
  origin = local_origin(points);
  if (origin == glm::dvec3(0.0)) return;
  for (std::size_t i = 0; i < points.size(); ++i) positions[i] = glm::vec3(points[i] - origin);
}

template <int N>
json array_of(const std::vector<glm::vec<N, float>>& list) {
  json numbers = json::array();
  for (const auto& vector : list)
    for (int c = 0; c < N; ++c) numbers.push_back(vector[c]);
  return numbers;
}

std::uint32_t whole(const json& value, const std::string& path) {
  if (!value.is_number_integer() || value.get<std::int64_t>() < 0 ||
      value.get<std::int64_t>() > 0xffffffffll)
    throw unreadable(path + " must be a whole number of 0 or above", path);
  return value.get<std::uint32_t>();
}

}  // namespace

std::vector<std::string> mesh_generators() {
  std::vector<std::string> names;
  for (const auto& [name, maker] : makers()) names.push_back(name);
  return names;
}

Mesh read_mesh(const json& value, const std::string& path,
               const std::function<std::uint32_t(const json&, const std::string&)>& material_of,
               glm::dvec3& origin) {
  JsonReader reader(value, path);
  Mesh mesh;
  origin = glm::dvec3(0.0);
  if (reader.has("generator")) {
    Maker maker = nullptr;
    std::vector<std::pair<const char*, Maker>> choices;
    for (const auto& [name, make] : makers()) choices.emplace_back(name.c_str(), make);
    reader.choice("generator", maker, choices);
    const std::uint32_t material = material_of(reader.at("material"), reader.path_of("material"));
    double crease = 35.0, tile = 1.0;
    reader.number("crease", crease, 0.0, 180.0);
    reader.number("tile", tile, 1e-6, 1e6);
    try {
      mesh = to_mesh(maker(reader), crease, 1.0 / tile);
    } catch (const Error& error) {
      if (error.code == "unreadable") throw;
      throw unreadable(path + ": " + error.what(), path);
    }
    mesh.primitives[0].material = material;
  } else {
    reader.at("positions");
    read_positions(reader, mesh.positions, origin);
    read_array<3>(reader, "normals", 2.0, mesh.normals);
    read_array<2>(reader, "uvs", max_coordinate, mesh.uvs);
    read_array<4>(reader, "colors", 1e6, mesh.colors);
    const json& indices = reader.at("indices");
    if (!indices.is_array() || indices.size() % 3 != 0)
      reader.fail("indices", "must be a list of three numbers per triangle");
    for (std::size_t i = 0; i < indices.size(); ++i) {
      mesh.indices.push_back(whole(indices[i], reader.path_of("indices")));
      if (mesh.indices.back() >= mesh.positions.size())
        reader.fail("indices", "has an index beyond positions");
    }
    const json& primitives = reader.at("primitives");
    if (!primitives.is_array()) reader.fail("primitives", "must be a list");
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      JsonReader entry(primitives[i], reader.path_of("primitives") + "[" + std::to_string(i) + "]");
      Primitive primitive;
      primitive.first_index = whole(entry.at("first_index"), entry.path_of("first_index"));
      primitive.index_count = whole(entry.at("index_count"), entry.path_of("index_count"));
      primitive.material = material_of(entry.at("material"), entry.path_of("material"));
      entry.finish();
      mesh.primitives.push_back(primitive);
    }
    if (mesh.normals.empty()) compute_normals(mesh, 35.0);
  }
  reader.text("name", mesh.name);
  reader.finish();
  return mesh;
}

json write_mesh(const Mesh& mesh) {
  json value = {{"name", mesh.name},
                {"positions", array_of(mesh.positions)},
                {"normals", array_of(mesh.normals)},
                {"indices", mesh.indices},
                {"primitives", json::array()}};
  if (!mesh.uvs.empty()) value["uvs"] = array_of(mesh.uvs);
  if (!mesh.colors.empty()) value["colors"] = array_of(mesh.colors);
  for (const Primitive& primitive : mesh.primitives)
    value["primitives"].push_back({{"first_index", primitive.first_index},
                                   {"index_count", primitive.index_count},
                                   {"material", primitive.material}});
  return value;
}

}  // namespace penumbra::scenes
