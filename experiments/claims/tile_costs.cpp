// Claims on what irregular adaptive shadow maps cost against cascades (Alecu 2014).
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

#include "experiments/claims/claim.h"
#include "experiments/claims/hard_light.h"
#include "experiments/report/rows.h"
#include "renderer/scene/convex_clip.h"
#include "scenes/generators/scene_builder.h"
#include "techniques/registry.h"

namespace penumbra::experiments::claims {
namespace {

Outcome c09(Laboratory& lab) {
  Outcome outcome;
  const auto ratio = [&](const char* scene) {
    const double tiles = sum_over_passes(lab.row(scene, "iasm"), "shadow map", "median_ms");
    const double cascades = sum_over_passes(lab.row(scene, "cascaded"), "shadow map", "median_ms");
    outcome.number(std::string("maps' passes, IASM over CSM, ") + scene, tiles / cascades);
    return tiles / cascades;
  };
  outcome.part(ratio("trees") < 1.0);
  outcome.part(ratio("village") > 2.0);
  return outcome;
}

/// What a frame takes from its first submission to the next frame's beyond its passes, ms: with the
/// host's own work, and its waiting. From the difference between many frames and few.
double beyond_passes(Laboratory& lab, const std::string& scene, const std::string& technique) {
  const auto resolved = techniques::resolve(technique);
  RenderRequest request;
  request.scene = lab.engine().scene(scene);
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.width = request.height = lab.scale().size;
  request.settle = true;  // as long for few frames as for many, once clocks are up
  double passes = 0.0;
  const auto seconds = [&](std::uint32_t frames) {
    request.frames = frames;
    const auto start = std::chrono::steady_clock::now();
    passes = lab.engine().renderer().render(request).cost.median_ms;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  constexpr std::uint32_t few = 4, many = 24;
  seconds(few);  // compiles
  const double first = seconds(few);
  return 1e3 * (seconds(many) - first) / (many - few) - passes;
}

Outcome c10(Laboratory& lab) {
  Outcome outcome;
  for (const std::string scene : {"trees", "village"}) {
    const auto stall = [&](const std::string& technique) {
      const double ms = beyond_passes(lab, scene, technique);
      outcome.number("ms of a frame beyond its passes, " + technique + ", " + scene, ms);
      return ms;
    };
    const double waits = stall("iasm"), late = stall("iasm-delayed");
    stall("iasm-gpu");
    outcome.part(late < 0.5 * waits);
  }
  return outcome;
}

Outcome c15(Laboratory& lab) {
  Outcome outcome;
  for (const auto& [scene, published] : {std::pair{"trees", 1.05}, {"village", 2.9}}) {
    const double cascades = lab.value("frame_ms", scene, "cascaded");
    const double late = lab.value("frame_ms", scene, "iasm-delayed") / cascades;
    const double now = lab.value("frame_ms", scene, "iasm") / cascades;
    outcome.number(std::string("delayed IASM over CSM, ") + scene, late);
    outcome.number(std::string("IASM over CSM, ") + scene, now);
    outcome.part(std::abs(late - published) < 0.15 * published);
    outcome.part(now > 1.0);
  }
  return outcome;
}

std::uint64_t map_vertices(const RenderResult& drawn) {
  std::uint64_t vertices = 0;
  for (const PassCost& pass : drawn.cost.passes)
    if (pass.name == "shadow map") vertices += pass.vertices;
  return vertices;
}

/// Hills of one mesh all round a camera.
SharedScene one_mesh() {
  scenes::SceneBuilder b("hills", "Hills of one mesh");
  const scenes::Look grey = b.look("grey", glm::vec3(0.7f));
  Mesh mesh;
  scenes::add_part(mesh, scenes::box({-80.0, -0.2, -80.0}, {80.0, 0.0, 80.0}), grey);
  for (int i = -7; i <= 7; ++i)
    for (int k = -7; k <= 7; ++k) {
      const glm::dvec3 at(10.0 * i + 3.0, 0.0, 10.0 * k + 4.0);
      scenes::add_part(mesh, scenes::box(at, at + glm::dvec3(2.0, 1.0 + (i + k + 14) % 3, 2.0)),
                       grey);
    }
  b.place(b.add_mesh("hills", std::move(mesh)), glm::dmat4(1.0), "hills");
  b.sun({0.35, -1.0, 0.2}, glm::vec3(1.0f), 1.0f);
  b.camera("main", {0.0, 3.0, 0.0}, {1.0, 2.8, 0.2}, 50.0);
  return with_hard_lights(std::move(b.scene));
}

Outcome c16(Laboratory& lab) {
  Outcome outcome;
  const SharedScene scene = one_mesh();
  // A filter reads over borders, so that no tile is left out.
  const auto tiles = static_cast<double>(
      map_vertices(lab.draw(scene, "hills", "pcf-bilinear:layout=iasm:tile_radius=30")));
  const auto cascades = static_cast<double>(map_vertices(
      lab.draw(scene, "hills", "pcf-bilinear:layout=cascaded:cascades=3:map_size=1024")));
  outcome.number("vertices of IASM", tiles);
  outcome.number("of CSM", cascades);
  outcome.number("ratio (16/3)", tiles / cascades);
  outcome.part(3.0 * tiles == 16.0 * cascades);
  return outcome;
}

/// Casters that each tile drew, as a render's notes have them.
std::vector<int> casters_drawn(const RenderResult& drawn) {
  const std::string from = "casters, each material of an instance by itself: ";
  for (const std::string& note : drawn.notes) {
    const std::size_t begin = note.find(from);
    if (begin == std::string::npos) continue;
    std::istringstream text(note.substr(begin + from.size()));
    std::vector<int> counts;
    for (std::string count; std::getline(text, count, ',');) counts.push_back(std::stoi(count));
    return counts;
  }
  throw std::logic_error("no note tells what tiles draw");
}

/// Whether a triangle of a primitive reaches into a tile, by clipping it in double precision.
bool reaches(const Mesh& mesh, const Primitive& primitive, const glm::dmat4& world_from_object,
             const std::array<HalfSpace, 4>& sides) {
  for (std::uint32_t i = 0; i < primitive.index_count; i += 3) {
    std::vector<glm::dvec3> polygon;
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = mesh.indices[primitive.first_index + i + corner];
      polygon.emplace_back(world_from_object * glm::dvec4(mesh.positions[vertex], 1.0));
    }
    for (const HalfSpace& side : sides) polygon = clip(polygon, side);
    if (polygon.size() >= 3) return true;
  }
  return false;
}

/// Casters that really reach into each tile, of a square of a given radius.
std::vector<int> casters_within(const Scene& scene, double radius) {
  const FixedAxes axes = axes_of(scene.lights.front());
  const Camera& camera = scene.cameras.front();
  const auto on_plane = [&](const glm::dvec3& v) {
    return glm::dvec2(glm::dot(v, axes.right), glm::dot(v, axes.up));
  };
  const glm::dvec2 center =
      on_plane(camera.position) +
      radius * glm::normalize(on_plane(glm::normalize(camera.target - camera.position)));
  std::vector<int> counts;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const double half = radius / 4.0;
      const glm::dvec2 middle = center + half * glm::dvec2(2 * column - 3, 3 - 2 * row);
      const std::array<HalfSpace, 4> sides{
          HalfSpace(axes.right, half - middle.x), HalfSpace(-axes.right, half + middle.x),
          HalfSpace(axes.up, half - middle.y), HalfSpace(-axes.up, half + middle.y)};
      int count = 0;
      for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        for (const Primitive& primitive : mesh.primitives)
          count +=
              instance.casts_shadow && reaches(mesh, primitive, instance.world_from_object, sides);
      }
      counts.push_back(count);
    }
  return counts;
}

Outcome c17(Laboratory& lab) {
  Outcome outcome;
  // Without the ground, which lies in every tile.
  Scene trees = *lab.engine().scene("trees");
  for (Instance& instance : trees.instances)
    if (instance.name == "meadow") instance.casts_shadow = false;
  const SharedScene scene = with_hard_lights(std::move(trees));
  // A filter reads over borders, so that no tile is left out.
  const std::string map = "pcf-bilinear:layout=iasm:tile_radius=60:tile_culling=";
  const auto spheres = casters_drawn(lab.draw(scene, "trees", map + "spheres"));
  const auto boxes = casters_drawn(lab.draw(scene, "trees", map + "boxes"));
  const auto exact = casters_within(*scene, 60.0);
  bool in_order = true;
  int drawn_in_vain = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    in_order = in_order && spheres[i] >= boxes[i] && boxes[i] >= exact[i];
    drawn_in_vain += spheres[i] > 0 && boxes[i] == 0;
  }
  const auto sum = [](const std::vector<int>& counts) {
    return static_cast<double>(std::accumulate(counts.begin(), counts.end(), 0));
  };
  outcome.number("casters drawn, spheres", sum(spheres));
  outcome.number("boxes", sum(boxes));
  outcome.number("that reach into tiles", sum(exact));
  outcome.number("tiles that only spheres draw in", drawn_in_vain);
  outcome.part(in_order && sum(spheres) > sum(boxes));
  outcome.part(drawn_in_vain > 0);
  return outcome;
}

Outcome c29(Laboratory& lab) {
  Outcome outcome;
  const SharedScene scene = with_hard_lights(*lab.engine().scene("trees"));
  const auto bytes = [&](const char* range) {
    const RenderResult drawn =
        lab.draw(scene, "trees", std::string("shadow-map:layout=iasm:tile_range=") + range);
    double sum = 0.0;
    for (const ResourceCost& cost : drawn.cost.technique_memory)
      if (cost.name == "importance of tiles") sum += static_cast<double>(cost.bytes);
    outcome.number(std::string("bytes read back, ") + range, sum);
    return sum;
  };
  outcome.part(bytes("casters") < bytes("visible"));
  outcome.note = "importance and both distances stand in one buffer here, which is read whole";
  return outcome;
}

}  // namespace

std::vector<Claim> tile_cost_claims() {
  return {
      {"C09", "S1 table 4.1", "IASM is cheaper than CSM on trees, dearer on one mesh",
       "maps' passes over CSM's below 1 on trees (0.85); over 2 on village (5.2)", c09, Needs::gpu},
      {"C10", "S1 table 4.1", "delayed read-back removes most of the stall",
       "what the frame takes beyond its passes, below half, on trees; on village", c10, Needs::gpu},
      {"C15", "S1 table 4.1",
       "delayed IASM costs 1.05 of CSM on trees, 2.9 on the mesh; IASM that waits never wins",
       "ratio of frames within 15%, trees; that of IASM over 1; village; over 1", c15, Needs::gpu},
      {"C16", "S1 table 4.1", "on one mesh IASM draws 16/3 of CSM's vertices",
       "vertices counted, exactly", c16},
      {"C17", "S1 4.3", "bounding spheres draw tiles that boxes leave empty",
       "casters but the ground drawn in every tile: spheres no fewer than boxes, these no fewer "
       "than those that "
       "reach into it; some tile draws by spheres alone",
       c17},
      {"C29", "S1 table 4.1", "forward IASM reads back less than deferred", "bytes read back", c29},
  };
}

}  // namespace penumbra::experiments::claims
