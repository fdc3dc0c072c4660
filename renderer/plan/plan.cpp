#include "renderer/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "renderer/scene/convex_clip.h"
#include "renderer/scene/light.h"
#include "renderer/scene/transforms.h"

namespace penumbra {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Above this many caster-surface pairs, test against one common box.
constexpr std::size_t most_pairs = 4'000'000;

/// What the camera sees: half-spaces, and the corners where they begin.
struct View {
  std::vector<HalfSpace> sides;
  std::vector<glm::dvec3> corners;
};

View view_of(const CameraMatrices& camera) {
  View view;
  const auto sides = side_planes(camera.clip_from_world);
  view.sides.assign(sides.begin(), sides.end());
  view.sides.push_back(near_plane(camera.clip_from_world));
  const auto corners = near_corners(camera);
  view.corners.assign(corners.begin(), corners.end());
  return view;
}

/// At most: a triangle may repeat one vertex (GpuScene::add_facets). There are two lists of
/// indices, of surfaces and of casters.
std::uint64_t geometry_bytes(const Mesh& mesh) {
  return (mesh.positions.size() + mesh.indices.size() / 3) * vertex_bytes +
         2 * mesh.indices.size() * sizeof(std::uint32_t);
}

std::uint64_t texture_bytes(const Texture& texture) {
  return texture.rgba.size() + texture.rgba.size() / 3;  // with its mip levels
}

class Planner {
 public:
  Planner(const RenderRequest& request, const ParameterValues& parameters,
          const std::vector<Bounds>& boxes, const Camera* through)
      : request_(request), rules_(request.rules), scene_(*request.scene), boxes_(boxes) {
    camera_ = through != nullptr ? through : &scene_.cameras[find_camera(scene_, request.camera)];
    if (!request.earlier_cameras.empty()) rules_.lights = rules_.surfaces = rules_.casters = false;
    plan_.needs = requirements_of(request, parameters, boxes);
  }

  Plan make() {
    find_visible();
    plan_.instances.assign(scene_.instances.size(), {true, false});
    for (std::size_t i = 0; i < scene_.instances.size(); ++i)
      plan_.instances[i].visible = !rules_.surfaces || !seen_[i].empty();
    for (std::size_t l = 0; l < scene_.lights.size(); ++l) plan_light(l);
    explain_instances();
    plan_textures();
    explain_requirements();
    return std::move(plan_);
  }

 private:
  void find_visible() {
    // How deep an orthographic camera's volume reaches plays no part: its far end is not looked at.
    const View view = view_of(camera_matrices(
        *camera_, glm::dvec3(0.0), static_cast<double>(request_.width) / request_.height, 1.0));
    for (const Bounds& box : boxes_)
      seen_.push_back(may_touch(box, view.sides) ? common_part(box, view.sides, view.corners)
                                                 : Bounds{});
  }

  void plan_light(std::size_t index) {
    const Light& light = scene_.lights[index];
    const LightReach reach(light);
    std::vector<Bounds> lit;
    if (reach.shines())
      for (const Bounds& box : seen_)
        if (!box.empty())
          if (const Bounds part = reach.lit(box); !part.empty()) lit.push_back(part);
    const bool kept = !rules_.lights || !lit.empty();
    plan_.lights.push_back(kept);
    line("lights", light.name, !lit.empty(),
         lit.empty()
             ? (reach.shines() ? "reaches nothing that the camera sees" : "has no intensity")
             : "reaches " + std::to_string(lit.size()) + " of the visible instances");
    plan_.fits.push_back(fit_of(reach, lit));
    if (!kept) return;
    if (plan_.needs[index].casters == CasterUse::cone) explain_depth_range(light.name, reach);
    if (lit.size() * boxes_.size() > most_pairs) {
      Bounds all;
      for (const Bounds& box : lit) all.add(box);
      lit = {all};
    }
    for (std::size_t i = 0; i < boxes_.size(); ++i)
      if (scene_.instances[i].casts_shadow && casts(reach, plan_.needs[index], boxes_[i], lit))
        plan_.instances[i].casts = true;
  }

  LightFit fit_of(const LightReach& reach, const std::vector<Bounds>& lit) const {
    if (!rules_.depth_range) return {boxes_, boxes_};
    LightFit fit;
    fit.receivers = lit;
    for (std::size_t i = 0; i < boxes_.size(); ++i)
      if (scene_.instances[i].casts_shadow && reach.may_touch_cone(boxes_[i], widest_filtered_cone))
        fit.casters.push_back(boxes_[i]);
    return fit;
  }

  void explain_depth_range(const std::string& light, const LightReach& reach) {
    const auto in_metres = [](double value) {
      char text[32];
      std::snprintf(text, sizeof(text), "%.4g", value);
      return std::string(text);
    };
    glm::dvec2 fitted(infinity, -infinity);
    glm::dvec2 scene = fitted;
    for (const Bounds& box : plan_.fits.back().casters)
      fitted.x = std::min(fitted.x, reach.distances(box).x);
    for (const Bounds& box : plan_.fits.back().receivers) {
      fitted.x = std::min(fitted.x, reach.distances(box).x);
      fitted.y = std::max(fitted.y, reach.distances(box).y);
    }
    for (const Bounds& box : boxes_) {
      scene.x = std::min(scene.x, reach.distances(box).x);
      scene.y = std::max(scene.y, reach.distances(box).y);
    }
    if (fitted.y < fitted.x) return;  // nothing seen
    line("depth range", light, true,
         "what matters lies " + in_metres(fitted.x) + " to " + in_metres(fitted.y) +
             " m along its axis, the scene " + in_metres(scene.x) + " to " + in_metres(scene.y));
  }

  bool casts(const LightReach& reach, const Requirements& needs, const Bounds& caster,
             const std::vector<Bounds>& lit) const {
    if (needs.casters == CasterUse::none) return false;
    if (!rules_.casters || needs.casters == CasterUse::all) return true;
    if (needs.casters == CasterUse::cone) return reach.may_touch_cone(caster, widest_filtered_cone);
    return std::any_of(lit.begin(), lit.end(),
                       [&](const Bounds& part) { return reach.may_shadow(caster, part); });
  }

  void explain_instances() {
    std::vector<std::uint64_t> mesh_bytes;
    for (const Mesh& mesh : scene_.meshes) mesh_bytes.push_back(geometry_bytes(mesh));
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
      const Instance& instance = scene_.instances[i];
      const InstanceUse& use = plan_.instances[i];
      const bool uploaded = use.visible || use.casts;
      const std::uint64_t bytes = mesh_bytes[instance.mesh];
      line("surfaces", instance.name, use.visible,
           seen_[i].empty() ? "outside the camera's view" : "the camera may see it",
           use.visible || !uploaded ? bytes : 0);
      std::string why = "stands between no light and anything visible";
      if (!instance.casts_shadow)
        why = "casts no shadow";
      else if (use.casts)
        why = "may shadow something visible";
      else if (no_casters())
        why = request_.technique->id + " asks for no casters";
      line("casters", instance.name, use.casts, why, !use.visible && use.casts ? bytes : 0);
    }
  }

  bool no_casters() const {
    return std::all_of(plan_.needs.begin(), plan_.needs.end(),
                       [](const Requirements& needs) { return needs.casters == CasterUse::none; });
  }

  void plan_textures() {
    plan_.textures.assign(scene_.textures.size(), !rules_.textures);
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
      const InstanceUse& use = plan_.instances[i];
      for (const Primitive& primitive : scene_.meshes[scene_.instances[i].mesh].primitives) {
        const Material& material = scene_.materials[primitive.material];
        const bool holes = material.alpha_mode == AlphaMode::mask;
        if (material.texture >= 0 && (use.visible || (use.casts && holes)))
          plan_.textures[static_cast<std::size_t>(material.texture)] = true;
      }
    }
    for (std::size_t t = 0; t < scene_.textures.size(); ++t)
      line("textures", scene_.textures[t].name, plan_.textures[t],
           plan_.textures[t] ? "on a visible surface, or the holes of a caster"
                             : "on nothing that is drawn",
           texture_bytes(scene_.textures[t]));
  }

  void explain_requirements() {
    const std::string& technique = request_.technique->id;
    const auto any = [&](auto member) {
      for (std::size_t l = 0; l < plan_.needs.size(); ++l)
        if (plan_.lights[l] && plan_.needs[l].*member) return true;
      return false;
    };
    const auto explain = [&](const char* rule, const char* subject, bool needed) {
      line(rule, subject, needed, technique + (needed ? " needs it" : " does not ask for it"));
    };
    explain("adjacency", "triangles with adjacency", any(&Requirements::adjacency));
    explain("stencil", "stencil plane", any(&Requirements::stencil));
    explain("hierarchy", "bounding volume hierarchy", any(&Requirements::acceleration_structure));
    for (std::size_t l = 0; l < plan_.needs.size(); ++l) {
      const Light& light = scene_.lights[l];
      if (!plan_.lights[l]) continue;
      const std::uint32_t points = plan_.needs[l].light_points;
      const bool hard = !has_extent(light);
      line("extent", light.name, points > 1,
           hard         ? "has no extent: hard shadows, one point"
           : points > 1 ? std::to_string(points) + " points on its extent, one by one"
                        : technique + " works from its centre");
    }
  }

  void line(const char* rule, const std::string& subject, bool kept, std::string reason,
            std::uint64_t bytes = 0) {
    plan_.lines.push_back({rule, subject, kept, std::move(reason), bytes});
  }

  const RenderRequest& request_;
  PlanRules rules_;
  const Scene& scene_;
  const std::vector<Bounds>& boxes_;
  const Camera* camera_;
  std::vector<Bounds> seen_;  ///< of each instance what the camera may see; empty: nothing
  Plan plan_;
};

}  // namespace

std::vector<Requirements> requirements_of(const RenderRequest& request,
                                          const ParameterValues& parameters,
                                          const std::vector<Bounds>& boxes) {
  const Scene& scene = *request.scene;
  const Camera& camera = scene.cameras[find_camera(scene, request.camera)];
  const Bounds box = around(boxes);
  std::vector<Requirements> list;
  for (const Light& light : scene.lights) {
    list.emplace_back();
    request.technique->create()->require(technique_input(request, box, light, camera, parameters),
                                         list.back());
  }
  return list;
}

std::vector<Bounds> instance_boxes(const Scene& scene) {
  std::vector<Bounds> boxes;
  for (const Instance& instance : scene.instances)
    boxes.push_back(instance_bounds(scene, instance));
  const Bounds all = around(boxes);
  if (all.empty()) return boxes;
  const glm::dvec3 eye = scene.cameras.front().position;
  for (Bounds& box : boxes) {
    // What is far away must not widen what is near: coordinates there are counted from nearby (see
    // SceneFrame).
    const double nearby = 1024.0 * (glm::length(box.size()) + glm::length(box.center() - eye));
    const double pad = 1e-6 * (std::min(glm::length(all.size()), nearby) + 1e-3);
    box.low -= pad;
    box.high += pad;
  }
  return boxes;
}

Plan make_plan(const RenderRequest& request, const ParameterValues& parameters,
               const std::vector<Bounds>& boxes, const Camera* through) {
  return Planner(request, parameters, boxes, through).make();
}

}  // namespace penumbra
