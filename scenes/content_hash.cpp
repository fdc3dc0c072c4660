#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstdio>
#include <memory>

#include "scenes/library.h"

namespace penumbra::scenes {
namespace {

/// Feeds values to XXH3 with their lengths, so that no two scenes give the same bytes.
class Hasher {
 public:
  Hasher() : state(XXH3_createState(), XXH3_freeState) { XXH3_128bits_reset(state.get()); }

  void bytes(const void* data, std::size_t size) {
    if (size > 0) XXH3_128bits_update(state.get(), data, size);
  }
  void number(double value) {
    const double same_zero = value + 0.0;  // -0 and 0 draw the same picture
    bytes(&same_zero, sizeof same_zero);
  }
  void text(const std::string& value) {
    number(static_cast<double>(value.size()));
    bytes(value.data(), value.size());
  }
  template <int N, class T>
  void vector(const glm::vec<N, T>& value) {
    for (int i = 0; i < N; ++i) number(static_cast<double>(value[i]));
  }
  /// Elements without padding.
  template <class T>
  void array(const std::vector<T>& values) {
    number(static_cast<double>(values.size()));
    bytes(values.data(), values.size() * sizeof(T));
  }

  std::string digits() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
    char text_buffer[33];
    std::snprintf(text_buffer, sizeof text_buffer, "%016llx%016llx",
                  static_cast<unsigned long long>(hash.high64),
                  static_cast<unsigned long long>(hash.low64));
    return text_buffer;
  }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state;
};

void add(Hasher& hasher, const Material& material) {
  hasher.vector(material.base_color);
  hasher.vector(material.emissive);
  for (const float value : {material.alpha, material.specular, material.shininess})
    hasher.number(static_cast<double>(value));
  hasher.number(material.texture);
  hasher.number(static_cast<double>(material.alpha_mode));
  hasher.number(static_cast<double>(material.alpha_cutoff));
  hasher.number(material.double_sided);
}

void add(Hasher& hasher, const Mesh& mesh) {
  hasher.array(mesh.positions);
  hasher.array(mesh.normals);
  hasher.array(mesh.uvs);
  hasher.array(mesh.colors);
  hasher.array(mesh.indices);
  hasher.array(mesh.primitives);
}

void add(Hasher& hasher, const Light& light) {
  hasher.text(light.name);  // names the visibility picture's channel
  hasher.number(static_cast<double>(light.kind));
  hasher.vector(light.position);
  hasher.vector(light.direction);
  hasher.vector(light.up);
  hasher.vector(light.color);
  hasher.number(static_cast<double>(light.intensity));
  hasher.number(static_cast<double>(light.attenuation));
  for (const double value : {light.inner_angle, light.outer_angle, light.range})
    hasher.number(value);
  hasher.number(static_cast<double>(light.extent.kind));
  hasher.number(light.extent.radius);
  hasher.vector(light.extent.size);
}

void add(Hasher& hasher, const Camera& camera) {
  hasher.text(camera.name);  // requests choose by it
  hasher.vector(camera.position);
  hasher.vector(camera.target);
  hasher.vector(camera.up);
  hasher.number(static_cast<double>(camera.projection));
  for (const double value : {camera.vertical_fov, camera.orthographic_height, camera.near_plane})
    hasher.number(value);
}

}  // namespace

std::string content_hash(const Scene& scene) {
  Hasher hasher;
  hasher.text("penumbra scene 1");
  for (const std::size_t count :
       {scene.textures.size(), scene.materials.size(), scene.meshes.size(), scene.instances.size(),
        scene.lights.size(), scene.cameras.size(), scene.receivers.size()})
    hasher.number(static_cast<double>(count));
  for (const Texture& texture : scene.textures) {
    hasher.number(texture.width);
    hasher.number(texture.height);
    hasher.array(texture.rgba);
  }
  for (const Material& material : scene.materials) add(hasher, material);
  for (const Mesh& mesh : scene.meshes) add(hasher, mesh);
  for (const Instance& instance : scene.instances) {
    hasher.number(instance.mesh);
    for (int column = 0; column < 4; ++column) hasher.vector(instance.world_from_object[column]);
    hasher.number(instance.casts_shadow);
  }
  for (const Light& light : scene.lights) add(hasher, light);
  for (const Camera& camera : scene.cameras) add(hasher, camera);
  for (const PlanarReceiver& receiver : scene.receivers) {
    hasher.number(static_cast<double>(receiver.corners.size()));
    for (const glm::dvec3& corner : receiver.corners) hasher.vector(corner);
  }
  for (const ShadowPlane& plane : scene.shadow_planes) {
    hasher.text("shadow plane");
    hasher.vector(plane.center);
    hasher.vector(plane.right);
    hasher.vector(plane.up);
    hasher.number(plane.size.x);
    hasher.number(plane.size.y);
    hasher.text(plane.texture);
    // The texture is found by its name, so the names of textures are part of the picture here.
    for (const Texture& texture : scene.textures) hasher.text(texture.name);
    hasher.number(static_cast<double>(plane.casters.size()));
    for (const std::string& caster : plane.casters) hasher.text(caster);
    hasher.number(plane.receivers.empty() ? 0.0 : 1.0);
    if (plane.receivers.empty()) continue;
    hasher.vector(plane.receivers.low);
    hasher.vector(plane.receivers.high);
  }
  hasher.vector(scene.ambient);
  hasher.vector(scene.background_low);
  hasher.vector(scene.background_high);
  hasher.number(static_cast<double>(scene.exposure));
  return hasher.digits();
}

}  // namespace penumbra::scenes
