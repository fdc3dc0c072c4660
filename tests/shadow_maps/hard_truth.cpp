#include "hard_truth.h"

#include <cmath>

#include "renderer/scene/transforms.h"

namespace penumbra::tests {
namespace {

constexpr unsigned front_sided = 1;
constexpr unsigned double_sided = 2;

/// Single-sided surfaces are seen from their front alone, as the rasteriser has it.
void skip_back_faces(const RTCFilterFunctionNArguments* arguments) {
  const RTCRay* ray = reinterpret_cast<const RTCRay*>(arguments->ray);
  const RTCHit* hit = reinterpret_cast<const RTCHit*>(arguments->hit);
  const float facing = ray->dir_x * hit->Ng_x + ray->dir_y * hit->Ng_y + ray->dir_z * hit->Ng_z;
  if (facing > 0.0f) arguments->valid[0] = 0;
}

void add_triangles(RTCDevice device, RTCScene target, const Mesh& mesh, const Primitive& part,
                   const glm::dmat4& world_from_object, bool cull) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<glm::vec3*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(glm::vec3), mesh.positions.size()));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    positions[i] = glm::vec3(world_from_object * glm::dvec4(mesh.positions[i], 1.0));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), part.index_count / 3));
  const bool mirrored = glm::determinant(world_from_object) < 0.0;
  for (std::uint32_t i = 0; i < part.index_count; i += 3) {
    indices[i] = mesh.indices[part.first_index + i];
    indices[i + 1] = mesh.indices[part.first_index + i + (mirrored ? 2 : 1)];
    indices[i + 2] = mesh.indices[part.first_index + i + (mirrored ? 1 : 2)];
  }
  rtcSetGeometryMask(geometry, cull ? front_sided : double_sided);
  if (cull) rtcSetGeometryIntersectFilterFunction(geometry, skip_back_faces);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(target, geometry);
  rtcReleaseGeometry(geometry);
}

RTCRay make_ray(const glm::dvec3& origin, const glm::dvec3& direction, double length) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x);
  ray.org_y = static_cast<float>(origin.y);
  ray.org_z = static_cast<float>(origin.z);
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tfar = static_cast<float>(length);
  ray.mask = ~0u;
  return ray;
}

}  // namespace

HardTruth::HardTruth(const Scene& scene) : scene_(scene), device_(rtcNewDevice("threads=1")) {
  casters_ = rtcNewScene(device_);
  surfaces_ = rtcNewScene(device_);
  rtcSetSceneFlags(casters_, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneFlags(surfaces_, RTC_SCENE_FLAG_ROBUST);
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (const Primitive& part : mesh.primitives) {
      const bool cull = !scene.materials[part.material].double_sided;
      add_triangles(device_, surfaces_, mesh, part, instance.world_from_object, cull);
      if (instance.casts_shadow)
        add_triangles(device_, casters_, mesh, part, instance.world_from_object, false);
    }
  }
  rtcCommitScene(casters_);
  rtcCommitScene(surfaces_);
  const Bounds bounds = world_bounds(scene);
  size_ = glm::length(bounds.size());
}

HardTruth::~HardTruth() {
  rtcReleaseScene(casters_);
  rtcReleaseScene(surfaces_);
  rtcReleaseDevice(device_);
}

bool HardTruth::sees(const glm::dvec3& from, const glm::dvec3& to) const {
  const glm::dvec3 offset = to - from;
  const double length = glm::length(offset);
  RTCRay ray = make_ray(from, offset / length, length - 1e-5 * size_);
  ray.tnear = static_cast<float>(1e-5 * size_);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(casters_, &context, &ray);
  return ray.tfar >= 0.0f;
}

ImageF HardTruth::visibility(const std::string& camera, std::uint32_t width,
                             std::uint32_t height) const {
  const Camera& eye = scene_.cameras[find_camera(scene_, camera)];
  const CameraMatrices matrices =
      camera_matrices(eye, glm::dvec3(0.0), static_cast<double>(width) / height, 0.5 * size_);
  ImageF result(width, height, static_cast<std::uint32_t>(scene_.lights.size()), 1.0f);
  RTCIntersectContext context;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const glm::dvec2 ndc(2.0 * (x + 0.5) / width - 1.0, 2.0 * (y + 0.5) / height - 1.0);
      const glm::dvec4 near = matrices.world_from_clip * glm::dvec4(ndc, 1.0, 1.0);
      const glm::dvec3 origin = glm::dvec3(near) / near.w;
      const glm::dvec3 direction = eye.projection == Projection::perspective
                                       ? glm::normalize(origin - matrices.position)
                                       : matrices.direction;
      RTCRayHit found{};
      found.ray = make_ray(origin, direction, 1e30);
      found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcInitIntersectContext(&context);
      rtcIntersect1(surfaces_, &context, &found);
      if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
      glm::dvec3 normal =
          glm::normalize(glm::dvec3(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z));
      if (glm::dot(normal, direction) > 0.0) normal = -normal;
      const glm::dvec3 point =
          origin + static_cast<double>(found.ray.tfar) * direction + 2e-6 * size_ * normal;
      for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
        const Light& light = scene_.lights[i];
        const glm::dvec3 end = light.kind == LightKind::directional
                                   ? point - 2.0 * size_ * glm::normalize(light.direction)
                                   : light.position;
        result.at(x, y, static_cast<std::uint32_t>(i)) = sees(point, end) ? 1.0f : 0.0f;
      }
    }
  }
  return result;
}

}  // namespace penumbra::tests
