// How long the reference takes, beside an Embree program that traces every one of its rays in
// packets of eight on the same cores. Rounds of both alternate, so that both meet the machine in
// the same mood.
//
//   bench_reference_embree [SCENE] [SIZE] [LIGHT_SAMPLES] [ROUNDS]
#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <thread>

#include "bench/program.h"
#include "renderer/frame/gpu_scene.h"
#include "renderer/reference/occlusion_mask.h"
#include "renderer/render.h"
#include "renderer/scene/light_points.h"
#include "renderer/scene/transforms.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Receiver {
  glm::vec3 origin;  ///< moved from its facet as the reference's is
  glm::vec3 normal;
};

/// Eight neighbouring points of a light, axis by axis.
struct alignas(32) Packet {
  float x[8], y[8], z[8];
};

std::vector<Packet> packets_of(const std::vector<glm::vec4>& points) {
  std::vector<Packet> packets(points.size() / 8);
  for (std::size_t i = 0; i < packets.size() * 8; ++i) {
    packets[i / 8].x[i % 8] = points[i].x;
    packets[i / 8].y[i % 8] = points[i].y;
    packets[i / 8].z[i % 8] = points[i].z;
  }
  return packets;
}

class EmbreeProgram {
 public:
  explicit EmbreeProgram(const GpuScene& scene)
      : device_(rtcNewDevice(nullptr)), casters_(add(scene, true)), all_(add(scene, false)) {}
  ~EmbreeProgram() {
    rtcReleaseScene(casters_);
    rtcReleaseScene(all_);
    rtcReleaseDevice(device_);
  }
  EmbreeProgram(const EmbreeProgram&) = delete;
  EmbreeProgram& operator=(const EmbreeProgram&) = delete;

  /// What the camera sees, above its facets by what rounding may have moved it.
  std::vector<Receiver> receivers(const GpuScene& gpu, const CameraMatrices& camera,
                                  std::uint32_t size) const;
  /// Rays that reach one of `points`, of all from `receivers`, on all cores; `w` of the points: 1
  /// for places, 0 for directions.
  std::uint64_t count_lit(const std::vector<Receiver>& receivers, const std::vector<Packet>& points,
                          float w) const;

 private:
  RTCScene add(const GpuScene& scene, bool casters_only);
  RTCDevice device_;
  RTCScene casters_, all_;
};

RTCScene EmbreeProgram::add(const GpuScene& scene, bool casters_only) {
  std::vector<std::uint32_t> indices;
  for (const DrawRange& range : scene.ranges())
    if (range.casts_shadow || !casters_only)
      indices.insert(indices.end(), scene.indices().begin() + range.first_index,
                     scene.indices().begin() + range.first_index + range.index_count);
  RTCScene made = rtcNewScene(device_);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::size_t vertices = scene.positions().size();
  std::memcpy(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertices),
      scene.positions().data(), vertices * 12);
  std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                      indices.size() / 3),
              indices.data(), indices.size() * 4);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(made, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(made);
  return made;
}

std::vector<Receiver> EmbreeProgram::receivers(const GpuScene& gpu, const CameraMatrices& camera,
                                               std::uint32_t size) const {
  std::vector<Receiver> list;
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const glm::dvec2 ndc = 2.0 * (glm::dvec2(x, y) + 0.5) / static_cast<double>(size) - 1.0;
      const glm::dvec4 near = camera.world_from_clip * glm::dvec4(ndc, 1.0, 1.0);
      const glm::vec3 start(glm::dvec3(near) / near.w);
      const glm::vec3 direction = glm::normalize(start - glm::vec3(camera.position));
      RTCRayHit query{};
      query.ray.org_x = start.x;
      query.ray.org_y = start.y;
      query.ray.org_z = start.z;
      query.ray.dir_x = direction.x;
      query.ray.dir_y = direction.y;
      query.ray.dir_z = direction.z;
      query.ray.tfar = std::numeric_limits<float>::infinity();
      query.ray.mask = ~0u;
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcIntersect1(all_, &context, &query);
      if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
      glm::vec3 normal = glm::normalize(glm::vec3(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z));
      if (glm::dot(normal, direction) > 0.0f) normal = -normal;
      const glm::vec3 position = start + query.ray.tfar * direction;
      list.push_back(
          {position + reference::rounding_of(gpu, position, camera.position) * normal, normal});
    }
  return list;
}

/// Eight rays of one receiver. Those to points behind its facet are hidden.
std::uint32_t lit_of_packet(RTCScene scene, RTCIntersectContext& context, const Receiver& receiver,
                            const Packet& points, float w) {
  alignas(32) RTCRay8 rays;
  alignas(32) int valid[8];
  const glm::vec3 from = w * receiver.origin;
  const float far = 1.0f / w;
  for (int i = 0; i < 8; ++i) {
    rays.org_x[i] = receiver.origin.x;
    rays.org_y[i] = receiver.origin.y;
    rays.org_z[i] = receiver.origin.z;
    rays.dir_x[i] = points.x[i] - from.x;
    rays.dir_y[i] = points.y[i] - from.y;
    rays.dir_z[i] = points.z[i] - from.z;
    rays.tnear[i] = 0.0f;
    rays.tfar[i] = far;
    rays.time[i] = 0.0f;
    rays.mask[i] = ~0u;
    rays.id[i] = 0;
    rays.flags[i] = 0;
    const float facing = rays.dir_x[i] * receiver.normal.x + rays.dir_y[i] * receiver.normal.y +
                         rays.dir_z[i] * receiver.normal.z;
    valid[i] = facing > 0.0f ? -1 : 0;
  }
  rtcOccluded8(valid, scene, &context, &rays);
  std::uint32_t lit = 0;
  for (int i = 0; i < 8; ++i) lit += valid[i] != 0 && rays.tfar[i] >= 0.0f;
  return lit;
}

std::uint64_t EmbreeProgram::count_lit(const std::vector<Receiver>& receivers,
                                       const std::vector<Packet>& points, float w) const {
  std::atomic<std::size_t> next{0};
  std::atomic<std::uint64_t> lit{0};
  const auto work = [&] {
    constexpr std::size_t chunk = 1024;
    std::uint64_t found = 0;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (std::size_t first = next.fetch_add(chunk); first < receivers.size();
         first = next.fetch_add(chunk))
      for (std::size_t r = first; r < std::min(first + chunk, receivers.size()); ++r)
        for (const Packet& packet : points)
          found += lit_of_packet(casters_, context, receivers[r], packet, w);
    lit += found;
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
    threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  return lit;
}

struct Timing {
  std::vector<double> shaded, visibility, embree;
};

void run(const std::string& name, std::uint32_t size, std::uint32_t samples, int rounds) {
  const std::shared_ptr<const Scene> scene = scenes::load(name);
  vulkan::Device device({"", false});
  const GpuScene gpu(device, scene, std::vector<InstanceUse>(scene->instances.size()),
                     std::vector<bool>(scene->textures.size(), true),
                     scene_frame(*scene, scene->cameras.front()));
  const EmbreeProgram embree(gpu);
  const CameraMatrices camera = camera_matrices(scene->cameras.front(), gpu.origin(), 1.0, 1.0);
  const std::vector<Receiver> receivers = embree.receivers(gpu, camera, size);

  Renderer renderer({"", false});
  const auto render = [&](const char* mode, std::uint32_t points) {
    const auto resolved = techniques::resolve("reference", {{"mode", mode}});
    RenderRequest request;
    request.scene = scene;
    request.technique = resolved.technique;
    request.parameters = resolved.parameters;
    request.width = request.height = size;
    request.light_samples = points;
    return renderer.render(request).cost.wall_median_ms;
  };
  // Shaders are compiled at their first use.
  for (const char* mode : {"shaded", "visibility"}) render(mode, 64);

  Timing timing;
  std::uint64_t lit = 0;
  for (int round = 0; round < rounds; ++round) {
    timing.shaded.push_back(render("shaded", samples));
    timing.visibility.push_back(render("visibility", samples));
    const auto start = Clock::now();
    lit = 0;
    for (const Light& light : scene->lights) {
      const WorldLight world = world_light(light, gpu.origin());
      lit += embree.count_lit(receivers, packets_of(light_points(world, samples, 1, 1, false)),
                              static_cast<float>(world.center.w));
    }
    timing.embree.push_back(ms_since(start));
  }
  const double rays =
      static_cast<double>(receivers.size()) * samples * static_cast<double>(scene->lights.size());
  const double embree_ms = penumbra::bench::median(timing.embree);
  std::printf("%s, %ux%u, %u light samples, %u threads, medians of %d rounds\n", name.c_str(), size,
              size, samples, std::thread::hardware_concurrency(), rounds);
  std::printf("device                %s\n", renderer.device().name.c_str());
  std::printf("rays                  %.0f, %.1f %% lit\n", rays,
              100.0 * static_cast<double>(lit) / rays);
  std::printf("Embree, every ray     %.0f ms, %.1f Mrays/s\n", embree_ms, rays / embree_ms / 1e3);
  const auto line = [&](const char* what, double ms) {
    std::printf("reference, %-10s %.0f ms, %.1f Mrays/s, %.2f of Embree's time\n", what, ms,
                rays / ms / 1e3, ms / embree_ms);
  };
  line("shaded", penumbra::bench::median(timing.shaded));
  line("visibility", penumbra::bench::median(timing.visibility));
}

}  // namespace
}  // namespace penumbra

int main(int count, char** values) {
  std::string scene = "boxes";
  std::uint32_t size = 600;
  std::uint32_t samples = 1024;
  int rounds = 5;
  return penumbra::bench::run_program(
      count, values, "The reference beside Embree, which traces every ray of it",
      [&](CLI::App& app) {
        app.add_option("SCENE", scene, "A built-in scene");
        app.add_option("SIZE", size, "Pixels, width and height")->check(CLI::PositiveNumber);
        app.add_option("SAMPLES", samples, "Light samples")->check(CLI::PositiveNumber);
        app.add_option("ROUNDS", rounds, "Rounds in turns")->check(CLI::PositiveNumber);
      },
      [&] { penumbra::run(scene, size, samples, rounds); });
}
