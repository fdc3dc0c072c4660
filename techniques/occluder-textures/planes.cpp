#include "techniques/occluder-textures/planes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <set>

namespace penumbra::techniques::occluder_textures {
namespace {

/// A body is flat where its thickness is less than this part of its second smallest side.
constexpr double flat = 0.35;
/// Straight-sided bodies are cut here, in parts of their half thickness from the middle.
constexpr double near_side = 0.9;
/// Sections near the sides must have this part of the middle section's area to count as straight.
constexpr double straight = 0.8;

/// A plane through the middle must meet this part of the silhouette: one that cuts a bent body in
/// thin air would shadow the body itself.
constexpr double met = 0.5;

/// A plane that is wanted, and by which bodies.
struct Candidate {
  Rectangle rectangle;  ///< its size is set when all bodies are known
  double thickness = 0.0;
  double area = 0.0;
  std::size_t model = 0;
  std::vector<const Body*> bodies;
  bool section = false;  ///< the texture is the body's section, not its silhouette
};

Rectangle across(const OrientedBox& box, int axis, double offset) {
  const int right = (axis + 1) % 3;
  const int up = (axis + 2) % 3;
  return {box.center + offset * box.half[axis] * box.axes[axis], box.axes[right], box.axes[up],
          glm::dvec2(2.0 * box.half[right], 2.0 * box.half[up])};
}

double section_area(const Body& body, const OrientedBox& box, int axis, double offset) {
  Picture picture(64);
  picture.add_section(across(box, axis, offset), body);
  return picture.filled();
}

bool meets_silhouette(const Body& body, const OrientedBox& box, int axis) {
  Picture picture(64);
  picture.add_silhouette(across(box, axis, 0.0), body);
  return section_area(body, box, axis, 0.0) >= met * picture.filled();
}

void add_candidates(const Body& body, const OrientedBox& box, std::vector<Candidate>& list) {
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return box.half[a] < box.half[b]; });
  const auto add = [&](int axis, double offset, bool section) {
    Candidate candidate;
    candidate.rectangle = across(box, axis, offset);
    candidate.thickness = 2.0 * box.half[axis];
    candidate.area = candidate.rectangle.size.x * candidate.rectangle.size.y;
    candidate.bodies = {&body};
    candidate.section = section;
    if (candidate.area > 0.0) list.push_back(candidate);
  };
  if (body.sheet) return add(order[0], 0.0, false);
  if (box.half[order[0]] <= flat * box.half[order[1]]) {
    if (meets_silhouette(body, box, order[0])) add(order[0], 0.0, false);
    return;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double middle = section_area(body, box, axis, 0.0);
    const double sides = std::min(section_area(body, box, axis, near_side),
                                  section_area(body, box, axis, -near_side));
    if (middle > 0.0 && sides >= straight * middle) {
      add(axis, near_side, true);
      add(axis, -near_side, true);
    } else if (meets_silhouette(body, box, axis)) {
      add(axis, 0.0, false);
    }
  }
}

/// Whether b's bodies may as well be cut by a's plane.
bool coincide(const Candidate& a, const Candidate& b) {
  if (a.section || b.section) return false;
  // A flat part shadows nothing near its plane: a body beside it must not go by that.
  if (a.bodies.front()->sheet != b.bodies.front()->sheet) return false;
  const glm::dvec3 normal = a.rectangle.normal();
  if (std::abs(glm::dot(normal, b.rectangle.normal())) < 0.9998) return false;
  const double offset = std::abs(glm::dot(normal, b.rectangle.center - a.rectangle.center));
  return offset < 0.25 * std::max(a.thickness, b.thickness);
}

/// Candidates that coincide become one, in the plane of the thinnest body: that one must be cut.
std::vector<Candidate> merged(std::vector<Candidate> list) {
  std::stable_sort(list.begin(), list.end(), [](const Candidate& a, const Candidate& b) {
    return a.thickness < b.thickness;
  });
  std::vector<Candidate> result;
  for (const Candidate& candidate : list) {
    const auto like = std::find_if(result.begin(), result.end(), [&](const Candidate& other) {
      return coincide(other, candidate);
    });
    if (like == result.end()) {
      result.push_back(candidate);
      continue;
    }
    like->area += candidate.area;
    like->bodies.insert(like->bodies.end(), candidate.bodies.begin(), candidate.bodies.end());
  }
  return result;
}

/// Moves and sizes a rectangle to hold bodies, with a margin of two texels.
void fit(Rectangle& rectangle, const std::vector<const Body*>& bodies, std::uint32_t resolution) {
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high = -low;
  for (const Body* body : bodies)
    for (const Triangle& triangle : body->triangles)
      for (const glm::dvec3& corner : triangle) {
        const glm::dvec3 offset = corner - rectangle.center;
        const glm::dvec2 at(glm::dot(offset, rectangle.right), glm::dot(offset, rectangle.up));
        low = glm::min(low, at);
        high = glm::max(high, at);
      }
  const glm::dvec2 middle = 0.5 * (low + high);
  rectangle.center += middle.x * rectangle.right + middle.y * rectangle.up;
  rectangle.size = (high - low) * (resolution / (resolution - 4.0));
}

void draw_silhouettes(Picture& picture, const Rectangle& rectangle,
                      const std::vector<const Body*>& casters, const std::vector<Body>& all,
                      const PlaneOptions& options) {
  for (const Body* body : casters) picture.add_silhouette(rectangle, *body);
  if (options.extend == 0) return;
  Picture inside(options.resolution), sheet(options.resolution);
  for (const Body& body : all)
    if (!body.sheet)
      inside.add_section(rectangle, body);
    else if (!casters.empty() && casters.front()->sheet && body.whole == casters.front()->whole)
      sheet.add_silhouette(rectangle, body);
  picture.extend_within(inside, options.extend);
  // No line of light between the parts of a sheet.
  picture.extend_within(sheet, 1);
}

/// How far from its plane a flat part reaches, and rounding.
double margin_of(const Rectangle& rectangle, const std::vector<const Body*>& bodies) {
  double farthest = 0.0;
  Bounds box;
  for (const Body* body : bodies) {
    if (!body->sheet) return 0.0;
    for (const Triangle& triangle : body->triangles)
      for (const glm::dvec3& corner : triangle) {
        box.add(corner);
        farthest =
            std::max(farthest, std::abs(glm::dot(corner - rectangle.center, rectangle.normal())));
      }
  }
  return 1.01 * farthest + 1e-5 * (glm::length(box.size()) + glm::length(box.center()));
}

/// Bytes that all textures of a light may take, and layers that a device is sure to have.
constexpr std::size_t most_texture_bytes = 64u << 20;
constexpr std::size_t most_textures = 1024;

/// Instances whose planes are the first one's, moved.
struct Model {
  std::vector<glm::dmat4> placed;  ///< from the first instance to each, in the renderer's space
  std::vector<Body> bodies;        ///< of the first instance
  std::size_t open = 0;            ///< of these, sheets that are cut as if they were closed
};

/// Whether a matrix keeps right angles and the ratio of lengths.
bool is_similarity(const glm::dmat4& m) {
  const glm::dmat3 linear(m);
  const glm::dmat3 product = glm::transpose(linear) * linear;
  const double scale = product[0][0];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (std::abs(product[i][k] - (i == k ? scale : 0.0)) > 1e-6 * scale) return false;
  return scale > 0.0;
}

std::vector<Model> find_models(const GpuScene& scene, const PlaneOptions& options) {
  std::set<std::uint32_t> casters;
  for (const DrawRange& range : scene.ranges())
    if (range.casts_shadow) casters.insert(range.instance);
  const auto& instances = scene.scene().instances;
  const glm::dmat4 shift = glm::translate(glm::dmat4(1.0), -scene.origin());
  std::vector<Model> models;
  std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::size_t>>> known;  // by mesh
  for (const std::uint32_t instance : casters) {
    auto& firsts = known[instances[instance].mesh];
    const glm::dmat4 own = shift * instances[instance].world_from_object;
    bool found = false;
    for (const auto& [first, model] : firsts) {
      const glm::dmat4 placed = own * glm::inverse(shift * instances[first].world_from_object);
      if (!is_similarity(placed)) continue;
      models[model].placed.push_back(placed);
      found = true;
      break;
    }
    if (found) continue;
    firsts.emplace_back(instance, models.size());
    FlatParts parts = in_flat_parts(find_bodies(scene, {instance}), options.most_planes);
    models.push_back({{glm::dmat4(1.0)}, std::move(parts.bodies), parts.open});
  }
  return models;
}

std::vector<Candidate> candidates_of(const GpuScene& scene, const Model& model) {
  std::vector<Candidate> list;
  for (const Body& body : model.bodies) {
    glm::dmat3 axes(scene.scene().instances[body.instance].world_from_object);
    for (int i = 0; i < 3; ++i) axes[i] = glm::normalize(axes[i]);
    axes[1] = glm::normalize(axes[1] - axes[0] * glm::dot(axes[0], axes[1]));
    axes[2] = glm::cross(axes[0], axes[1]);
    add_candidates(body, box_around(body, axes), list);
  }
  return merged(std::move(list));
}

void keep_largest(std::vector<Candidate>& list, std::size_t most) {
  std::stable_sort(list.begin(), list.end(),
                   [](const Candidate& a, const Candidate& b) { return a.area > b.area; });
  if (list.size() > most) list.resize(most);
}

Rectangle moved(const Rectangle& rectangle, const glm::dmat4& placed) {
  const glm::dmat3 linear(placed);
  const double scale = glm::length(linear[0]);
  return {glm::dvec3(placed * glm::dvec4(rectangle.center, 1.0)), linear * rectangle.right / scale,
          linear * rectangle.up / scale, scale * rectangle.size};
}

std::size_t count_represented(const std::vector<const Candidate*>& candidates) {
  std::set<const Body*> bodies;
  for (const Candidate* candidate : candidates)
    bodies.insert(candidate->bodies.begin(), candidate->bodies.end());
  return bodies.size();
}

}  // namespace

Bounds PlaneGroup::box() const {
  Bounds bounds;
  for (const OccluderPlane& plane : planes) bounds.add(plane.rectangle.bounds());
  return bounds;
}

std::size_t PlaneSet::planes() const {
  std::size_t count = 0;
  for (const PlaneGroup& group : groups) count += group.planes.size();
  return count;
}

PlaneSet generate_planes(const GpuScene& scene, const PlaneOptions& options) {
  const std::vector<Model> models = find_models(scene, options);
  std::vector<Candidate> list;
  for (std::size_t i = 0; i < models.size(); ++i) {
    std::vector<Candidate> own = candidates_of(scene, models[i]);
    keep_largest(own, options.most_planes);
    for (Candidate& candidate : own) {
      candidate.model = i;
      list.push_back(std::move(candidate));
    }
  }
  const std::size_t layer_bytes = std::size_t{options.resolution} * options.resolution;
  keep_largest(list, std::min(most_textures, most_texture_bytes / layer_bytes));
  PlaneSet set;
  std::vector<std::vector<OccluderPlane>> planes(models.size());
  std::vector<std::vector<const Candidate*>> kept(models.size());
  for (const Candidate& candidate : list) {
    const Model& model = models[candidate.model];
    OccluderPlane plane{candidate.rectangle,
                        set.textures.size(),
                        {},
                        margin_of(candidate.rectangle, candidate.bodies)};
    Picture picture(options.resolution);
    fit(plane.rectangle, candidate.bodies, options.resolution);
    if (candidate.section)
      picture.add_section(plane.rectangle, *candidate.bodies.front());
    else
      draw_silhouettes(picture, plane.rectangle, candidate.bodies, model.bodies, options);
    set.textures.push_back(std::move(picture));
    planes[candidate.model].push_back(plane);
    kept[candidate.model].push_back(&candidate);
  }
  for (std::size_t i = 0; i < models.size(); ++i) {
    set.open += models[i].open * models[i].placed.size();
    set.bodies += models[i].bodies.size() * models[i].placed.size();
    set.represented += count_represented(kept[i]) * models[i].placed.size();
    for (const glm::dmat4& placed : models[i].placed) {
      PlaneGroup group;
      for (OccluderPlane plane : planes[i]) {
        plane.margin *= glm::length(glm::dvec3(placed[0]));
        plane.rectangle = moved(plane.rectangle, placed);
        group.planes.push_back(plane);
      }
      if (!group.planes.empty()) set.groups.push_back(std::move(group));
    }
  }
  return set;
}

namespace {

/// Dark and opaque texels of a scene's texture stop light.
void draw_texture(Picture& picture, const Texture& texture) {
  for (std::uint32_t y = 0; y < picture.size(); ++y)
    for (std::uint32_t x = 0; x < picture.size(); ++x) {
      // Row 0 of a texture is on top.
      const std::uint32_t tx = (2 * x + 1) * texture.width / (2 * picture.size());
      const std::uint32_t ty =
          texture.height - 1 - (2 * y + 1) * texture.height / (2 * picture.size());
      const std::uint8_t* texel = &texture.rgba[4 * (std::size_t{ty} * texture.width + tx)];
      const double luminance = 0.299 * texel[0] + 0.587 * texel[1] + 0.114 * texel[2];
      picture.texels()[std::size_t{y} * picture.size() + x] =
          static_cast<std::uint8_t>(std::lround((255.0 - luminance) * texel[3] / 255.0));
    }
}

bool is_named(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

PlaneSet authored_planes(const GpuScene& scene, const PlaneOptions& options) {
  std::set<std::uint32_t> everything;
  for (const DrawRange& range : scene.ranges()) everything.insert(range.instance);
  const std::vector<Body> bodies = find_bodies(scene, everything);
  PlaneSet set;
  set.bodies = bodies.size();
  std::vector<bool> represented(bodies.size(), false);
  for (const ShadowPlane& authored : scene.scene().shadow_planes) {
    OccluderPlane plane;
    plane.rectangle = {authored.center - scene.origin(), authored.right, authored.up,
                       authored.size};
    plane.texture = set.textures.size();
    Picture picture(options.resolution);
    if (!authored.receivers.empty()) {
      plane.receivers.add(authored.receivers.low - scene.origin());
      plane.receivers.add(authored.receivers.high - scene.origin());
    }
    const auto& textures = scene.scene().textures;
    const auto texture = std::find_if(textures.begin(), textures.end(),
                                      [&](const Texture& t) { return t.name == authored.texture; });
    std::vector<const Body*> casters;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (is_named(authored.casters, scene.scene().instances[bodies[i].instance].name)) {
        casters.push_back(&bodies[i]);
        represented[i] = true;
      }
    if (!authored.texture.empty() && texture != textures.end())
      draw_texture(picture, *texture);
    else
      draw_silhouettes(picture, plane.rectangle, casters, bodies, options);
    set.textures.push_back(std::move(picture));
    set.groups.push_back({{plane}});
  }
  set.represented =
      static_cast<std::size_t>(std::count(represented.begin(), represented.end(), true));
  return set;
}

void sort_by_place(std::vector<PlaneGroup>& groups) {
  Bounds all;
  for (const PlaneGroup& group : groups) all.add(group.box().center());
  const glm::dvec3 cell = glm::max(all.size(), glm::dvec3(1e-30)) / 1023.0;
  std::vector<std::pair<std::uint64_t, PlaneGroup>> placed;
  for (PlaneGroup& group : groups) {
    const glm::uvec3 at((group.box().center() - all.low) / cell);
    std::uint64_t code = 0;
    for (int bit = 9; bit >= 0; --bit)
      for (int axis = 0; axis < 3; ++axis) code = code << 1 | (at[axis] >> bit & 1u);
    placed.emplace_back(code, std::move(group));
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < groups.size(); ++i) groups[i] = std::move(placed[i].second);
}

}  // namespace penumbra::techniques::occluder_textures
