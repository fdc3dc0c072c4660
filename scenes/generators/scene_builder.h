#pragma once

#include <string>

#include "renderer/scene/scene.h"
#include "scenes/generators/shapes.h"

namespace penumbra::scenes {

/// A material and how many metres one repeat of its texture covers.
struct Look {
  std::uint32_t material = 0;
  double tile = 1.0;
};

/// What a built-in scene's file is written in: looks, placed solids, lights by where they shine.
class SceneBuilder {
 public:
  SceneBuilder(const std::string& id, const std::string& title);

  /// A texture of scenes/generators/textures.h, 512 texels wide; its index. Equal ones are
  /// shared.
  int texture(const std::string& generator, std::uint32_t seed = 1, std::uint32_t size = 512);
  Look look(const std::string& name, const glm::vec3& color, int texture = -1, double tile = 1.0,
            float specular = 0.04f, float shininess = 32.0f);

  std::uint32_t add_mesh(const std::string& name, Mesh mesh);
  void place(std::uint32_t mesh, const glm::dmat4& world_from_object, const std::string& name = {});
  /// Mesh of one solid, placed once.
  void place(const Solid& solid, const Look& look, const std::string& name,
             const glm::dmat4& world_from_object = glm::dmat4(1.0), double crease = 35.0);

  /// Closed ground slab, upper side at y = 0, and the planar receiver on it.
  void ground(const glm::dvec2& low, const glm::dvec2& high, const Look& look,
              const std::string& name = "ground", double thickness = 0.2);

  /// Spot light without attenuation; angles in degrees from its axis.
  Light& spot(const std::string& name, const glm::dvec3& position, const glm::dvec3& target,
              const glm::vec3& color, float intensity, double outer_angle,
              const LightExtent& extent);
  /// Directional light from a disc as wide as the sun in the sky. `direction` need not be unit.
  Light& sun(const glm::dvec3& direction, const glm::vec3& color, float intensity);
  Camera& camera(const std::string& name, const glm::dvec3& position, const glm::dvec3& target,
                 double vertical_fov);

  Scene scene;
};

/// Adds a solid with its look to a mesh of several.
void add_part(Mesh& mesh, const Solid& solid, const Look& look,
              const glm::dmat4& transform = glm::dmat4(1.0), double crease = 35.0);

LightExtent disc(double radius);
LightExtent ball(double radius);
LightExtent rectangle(double width, double height);

}  // namespace penumbra::scenes
