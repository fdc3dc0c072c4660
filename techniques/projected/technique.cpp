#include <cmath>

#include "renderer/error.h"
#include "renderer/frame/prepare_context.h"

namespace penumbra::techniques {
namespace {

/// Receiver of receiver.glsl, before its sides.
struct ReceiverData {
  glm::mat4 clip_from_caster{1.0f};
  glm::vec4 plane{0.0f};
  glm::vec4 heights{0.0f};
};

/// Normal towards the receiving side and distance from the origin. A polygon without area has no
/// plane.
std::optional<glm::dvec4> plane_of(const std::vector<glm::dvec3>& corners) {
  if (corners.size() < 3) return std::nullopt;
  const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double length = glm::length(normal);
  if (!(length > 0.0)) return std::nullopt;
  return glm::dvec4(normal / length, glm::dot(normal / length, corners[0]));
}

/// Height above a plane, times w.
double height_of(const glm::dvec4& plane, const glm::dvec4& point) {
  return glm::dot(glm::dvec3(plane), glm::dvec3(point)) - plane.w * point.w;
}

/// Homogeneous projection onto the plane from the light (Blinn 1988): a caster at p goes to
/// l + (p - l) h(l) / (h(l) - h(p)) with h the height above the plane, or along the rays of a light
/// at infinity. Empty where the light is not on the receiving side.
std::optional<glm::dmat4> plane_from_caster(const glm::dvec4& plane, const WorldLight& light) {
  const double light_height = height_of(plane, light.center);
  if (light_height <= 0.0) return std::nullopt;
  const glm::dvec4 height(glm::dvec3(plane), -plane.w);  // row: height of a point
  glm::dmat4 rows(0.0);                                  // row i in column i, transposed at the end
  for (int i = 0; i < 4; ++i) {
    rows[i] = -height * light.center[i];
    rows[i][i] += light_height;
  }
  // Where no w depends on the point, it is made 1.
  if (is_at_infinity(*light.source)) rows /= light_height;
  return glm::transpose(rows);
}

class Projected : public Technique {
 public:
  void require(const TechniqueInput& input, Requirements& needs) override {
    needs.casters = CasterUse::beam;
    bool any = false;
    for (const PlanarReceiver& receiver : input.scene.receivers)
      any = any || plane_of(receiver.corners).has_value();
    if (!any)
      throw unsupported(
          "the scene declares no planar receivers, and projected shadows fall on nothing else",
          "scene");
  }

  void prepare(PrepareContext& context) override {
    if (!mask_) {
      vulkan::ImageDescription description;
      description.format = VK_FORMAT_R8_UNORM;
      description.width = context.geometry.width;
      description.height = context.geometry.height;
      description.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
      mask_ = vulkan::Image(context.device, context.memory, "shadow mask", description);
    }
    context.notes.push_back("projected shadows fall on the scene's planar receivers only");
    vulkan::RenderTargets targets;
    targets.width = context.geometry.width;
    targets.height = context.geometry.height;
    targets.colors = {{mask_.slice(0), true, {}}};
    context.pass("projected casters", [&](vulkan::Commands& commands) {
      commands.begin_rendering(targets);
      for (const PlanarReceiver& receiver : context.input.scene.receivers)
        draw_receiver(context, commands, receiver);
      commands.end_rendering();
    });
  }

  void bind(vulkan::Bindings& bindings) const override {
    bindings.texture("covered", mask_, vulkan::Sampling::nearest);
  }

 private:
  void draw_receiver(PrepareContext& context, vulkan::Commands& commands,
                     const PlanarReceiver& receiver) {
    std::vector<glm::dvec3> corners;
    for (const glm::dvec3& corner : receiver.corners)
      corners.push_back(corner - context.scene.origin());
    const auto plane = plane_of(corners);
    if (!plane) return;
    const auto onto_plane = plane_from_caster(*plane, context.light);
    if (!onto_plane) return;  // lit from below: the surface is dark without a shadow

    const glm::dvec3 normal(*plane);
    const glm::vec3 diagonal = context.scene.high() - context.scene.low();
    const double tolerance =
        real_of(context.input.parameters, "tolerance") * static_cast<double>(glm::length(diagonal));
    ReceiverData data;
    data.clip_from_caster = glm::mat4(context.camera.clip_from_world * *onto_plane);
    data.plane = glm::vec4(*plane);
    // A light at infinity is above everything.
    const glm::dvec4& light = context.light.center;
    const double light_height =
        std::min(height_of(*plane, light) / light.w, double{std::numeric_limits<float>::max()});
    data.heights = glm::vec4(tolerance, light_height, tolerance, corners.size());
    std::vector<glm::vec4> block(sizeof(ReceiverData) / sizeof(glm::vec4) + corners.size());
    std::memcpy(block.data(), &data, sizeof(data));
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::dvec3 side = corners[(i + 1) % corners.size()] - corners[i];
      const glm::dvec3 inwards = glm::cross(normal, side);
      block[block.size() - corners.size() + i] = glm::vec4(inwards, glm::dot(inwards, corners[i]));
    }

    CasterProgram program;
    program.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "techniques/projected/plane.vert"},
                      {VK_SHADER_STAGE_FRAGMENT_BIT, "techniques/projected/plane.frag"}};
    program.state.color_formats = {VK_FORMAT_R8_UNORM};
    vulkan::Bindings bindings;
    bindings.buffer("ReceiverBlock",
                    context.constants.push_array(std::span<const glm::vec4>(block)));
    context.draw_casters(commands, program, bindings, data.clip_from_caster);
  }

  vulkan::Image mask_;
};

}  // namespace

TechniqueDescription describe_projected() {
  const Parameter tolerance =
      real("tolerance", 1e-5, {0.0, 0.01},
           "Distance from a receiver's plane, in diagonals of the scene, within which a surface "
           "lies on it and nothing casts a shadow on it.");

  TechniqueDescription description;
  description.label = "Proj";
  description.title = "Projected planar shadows";
  description.family = "planar";
  description.source = "van Sambeek 2007, 2.3; Blinn 1988";
  description.parameters = {tolerance};
  description.create = create_technique<Projected>;
  return description;
}

}  // namespace penumbra::techniques
