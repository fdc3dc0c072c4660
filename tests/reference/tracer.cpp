#include "tracer.h"

#include <cstring>
#include <glm/gtc/packing.hpp>

namespace penumbra {
std::span<const EmbeddedFile> embedded_renderer_shaders();
}

namespace penumbra::tests {
namespace {

/// As renderer/shaders/geometry_buffer.glsl packs unit vectors.
std::uint32_t pack(glm::vec3 n) {
  n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  glm::vec2 p(n.x, n.y);
  if (n.z < 0.0f)
    p = {(1.0f - std::abs(n.y)) * (n.x >= 0.0f ? 1.0f : -1.0f),
         (1.0f - std::abs(n.x)) * (n.y >= 0.0f ? 1.0f : -1.0f)};
  return glm::packSnorm2x16(p);
}

glm::vec3 unpack(std::uint32_t word) {
  const glm::vec2 p = glm::unpackSnorm2x16(word);
  glm::vec3 n(p, 1.0f - std::abs(p.x) - std::abs(p.y));
  if (n.z < 0.0f)
    n = {(1.0f - std::abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f),
         (1.0f - std::abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f), n.z};
  return glm::normalize(n);
}

RTCRay ray(const glm::vec3& origin, const glm::vec3& direction, float far) {
  RTCRay made{};
  made.org_x = origin.x;
  made.org_y = origin.y;
  made.org_z = origin.z;
  made.dir_x = direction.x;
  made.dir_y = direction.y;
  made.dir_z = direction.z;
  made.tfar = far;
  made.mask = ~0u;
  return made;
}

/// A ray's own context: it leaves out what its receiver lies in.
struct FromSurface {
  RTCIntersectContext context;  ///< first, as Embree hands out pointers to it
  double rounding;              ///< how far the receiver may be from a triangle that it lies in
};

/// Leaves out triangles whose planes are no farther from the ray's origin than rounding.
void leave_own_plane(const RTCFilterFunctionNArguments* arguments) {
  const auto* from = reinterpret_cast<const FromSurface*>(arguments->context);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const glm::dvec3 normal(RTCHitN_Ng_x(arguments->hit, arguments->N, i),
                            RTCHitN_Ng_y(arguments->hit, arguments->N, i),
                            RTCHitN_Ng_z(arguments->hit, arguments->N, i));
    const glm::dvec3 along(RTCRayN_dir_x(arguments->ray, arguments->N, i),
                           RTCRayN_dir_y(arguments->ray, arguments->N, i),
                           RTCRayN_dir_z(arguments->ray, arguments->N, i));
    const double met = RTCRayN_tfar(arguments->ray, arguments->N, i);
    const double height = std::abs(met * glm::dot(normal, along)) / glm::length(normal);
    if (height <= from->rounding) arguments->valid[i] = 0;
  }
}

}  // namespace

Embree::Embree(const GpuScene& scene)
    : device_(rtcNewDevice("threads=1")), all_(add(scene, false)), casters_(add(scene, true)) {}

Embree::~Embree() {
  rtcReleaseScene(all_);
  rtcReleaseScene(casters_);
  rtcReleaseDevice(device_);
}

RTCScene Embree::add(const GpuScene& scene, bool casters_only) {
  std::vector<std::uint32_t> indices;
  for (const DrawRange& range : scene.ranges())
    if (range.casts_shadow || !casters_only)
      indices.insert(indices.end(), scene.indices().begin() + range.first_index,
                     scene.indices().begin() + range.first_index + range.index_count);
  RTCScene made = rtcNewScene(device_);
  rtcSetSceneFlags(made, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::size_t vertices = scene.positions().size() * sizeof(glm::vec3);
  std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                      scene.positions().size()),
              scene.positions().data(), vertices);
  std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                      indices.size() / 3),
              indices.data(), indices.size() * sizeof(indices[0]));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(made, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(made);
  return made;
}

std::vector<Receiver> Embree::receivers(const CameraMatrices& camera, std::uint32_t size) const {
  std::vector<Receiver> list;
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const glm::dvec2 ndc = 2.0 * (glm::dvec2(x, y) + 0.5) / static_cast<double>(size) - 1.0;
      const glm::dvec4 near = camera.world_from_clip * glm::dvec4(ndc, 1.0, 1.0);
      const glm::dvec3 start = glm::dvec3(near) / near.w;
      const glm::dvec3 direction = glm::normalize(start - camera.position);
      RTCRayHit query{};
      query.ray = ray(start, direction, std::numeric_limits<float>::infinity());
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcIntersect1(all_, &context, &query);
      Receiver receiver;
      if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
        const glm::vec3 normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
        const bool away = glm::dot(glm::dvec3(normal), direction) > 0.0;
        receiver.position = glm::vec3(start + static_cast<double>(query.ray.tfar) * direction);
        receiver.normal = unpack(pack(glm::normalize(away ? -normal : normal)));
        receiver.surface = true;
      }
      list.push_back(receiver);
    }
  return list;
}

bool Embree::hidden(const Receiver& receiver, float rounding, const glm::vec4& point) const {
  const glm::vec3 origin = receiver.position;
  const glm::vec3 direction = glm::vec3(point) - point.w * origin;
  if (glm::dot(receiver.normal, direction) <= 0.0f) return true;
  RTCRay query =
      ray(origin, direction, point.w > 0.5f ? 1.0f : std::numeric_limits<float>::infinity());
  FromSurface from;
  rtcInitIntersectContext(&from.context);
  from.context.filter = leave_own_plane;
  from.rounding = static_cast<double>(rounding);
  rtcOccluded1(casters_, &from.context, &query);
  return query.tfar < 0.0f;
}

Tracer::Tracer(std::shared_ptr<const Scene> scene)
    : device_({"", true}),
      pipelines_(device_, library_),
      recorder_(device_, pipelines_),
      constants_(device_, ledger_, 4u << 20),
      faults_(device_, ledger_, "faults", 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
              vulkan::MemoryKind::readback) {
  library_.add(embedded_renderer_shaders());
  std::memset(faults_.mapped(), 0, faults_.size());
  std::vector<InstanceUse> everything(scene->instances.size());
  std::vector<bool> textures(scene->textures.size(), true);
  const SceneFrame frame = scene_frame(*scene, scene->cameras.front());
  scene_ = std::make_unique<GpuScene>(device_, std::move(scene), std::move(everything),
                                      std::move(textures), frame);
}

std::uint32_t Tracer::unfinished() const {
  std::uint32_t count = 0;
  std::memcpy(&count, faults_.mapped(), sizeof(count));
  return count;
}

GeometryBuffer Tracer::upload_receivers(std::span<const Receiver> receivers, std::uint32_t size) {
  std::vector<glm::vec4> positions;
  std::vector<glm::uvec4> words;
  for (const Receiver& receiver : receivers) {
    positions.emplace_back(receiver.position, receiver.surface ? 1.0f : 0.0f);
    words.emplace_back(pack(receiver.normal), pack(receiver.normal), 0u, 0u);
  }
  const auto image = [&](const char* name, VkFormat format, const void* data) {
    vulkan::ImageDescription description;
    description.format = format;
    description.width = description.height = size;
    description.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    vulkan::Image made(device_, ledger_, name, description);
    const vulkan::Buffer staging(device_, ledger_, name, receivers.size() * 16,
                                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT, vulkan::MemoryKind::upload);
    std::memcpy(staging.mapped(), data, receivers.size() * 16);
    vulkan::run_now(device_, [&](VkCommandBuffer commands) {
      VkBufferImageCopy copy{};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      copy.imageExtent = {size, size, 1};
      vkCmdCopyBufferToImage(commands, staging.handle(), made.handle(), VK_IMAGE_LAYOUT_GENERAL, 1,
                             &copy);
    });
    return made;
  };
  GeometryBuffer buffer;
  buffer.position = image("positions", GeometryBuffer::position_format, positions.data());
  buffer.words = image("words", GeometryBuffer::words_format, words.data());
  buffer.width = buffer.height = size;
  return buffer;
}

std::vector<std::vector<std::uint32_t>> Tracer::masks(const Light& light,
                                                      std::span<const Receiver> receivers,
                                                      std::uint32_t size,
                                                      std::span<const glm::vec4> points,
                                                      std::uint32_t rounds) {
  constexpr std::size_t batch_size = shader::points_per_batch;
  const GeometryBuffer geometry = upload_receivers(receivers, size);
  const WorldLight world = world_light(light, scene_->origin());
  const ParameterValues none;
  const TechniqueInput input{scene_->scene(),
                             {},
                             light,
                             scene_->scene().cameras.front(),
                             none,
                             size,
                             size,
                             static_cast<std::uint32_t>(points.size()),
                             1};
  const CameraMatrices camera;
  const std::string declarations;
  std::vector<std::string> notes;
  shader::FrameData frame{};
  frame.size = glm::vec4(size, size, 1.0f, 1.0f);
  const glm::dvec3 eye = scene_->scene().cameras.front().position;
  frame.camera_position = glm::vec4(scene_->to_world(eye), 1.0f);
  const vulkan::Buffer copied(device_, ledger_, "masks", receivers.size() * 4,
                              VK_BUFFER_USAGE_TRANSFER_DST_BIT, vulkan::MemoryKind::readback);
  reference::OcclusionMask mask(rounds);
  const auto batches = static_cast<std::uint32_t>((points.size() + batch_size - 1) / batch_size);
  std::vector<std::vector<std::uint32_t>> result;
  for (std::uint32_t batch = 0; batch < batches; ++batch) {
    const std::size_t count = std::min(batch_size, points.size() - batch * batch_size);
    std::vector<glm::vec4> own(batch_size, points[batch * batch_size]);
    std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(batch * batch_size), count,
                own.begin());
    constants_.reset();
    vulkan::Bindings bindings;
    bindings.buffer("FrameBlock", constants_.push(frame));
    bindings.buffer("LightBlock",
                    constants_.push(light_data(world, static_cast<float>(count), 1.0f)));
    bindings.buffer("FaultBlock", faults_.whole());
    bindings.texture("geometry_position", geometry.position, vulkan::Sampling::nearest);
    bindings.texture("geometry_words", geometry.words, vulkan::Sampling::nearest);
    const LightFit fit;
    PrepareContext context{input,
                           *scene_,
                           world,
                           fit,
                           camera,
                           camera,
                           geometry,
                           device_,
                           pipelines_,
                           ledger_,
                           constants_,
                           recorder_,
                           bindings,
                           declarations,
                           own,
                           points,
                           static_cast<std::uint32_t>(count),
                           batch,
                           batches,
                           0,
                           notes,
                           nullptr};
    recorder_.begin(false);
    mask.trace(context);
    recorder_.pass("copy", [&](vulkan::Commands& commands) {
      const VkBufferCopy all{0, 0, copied.size()};
      vkCmdCopyBuffer(commands.handle(), mask.masks().handle(), copied.handle(), 1, &all);
    });
    recorder_.end();
    device_.throw_if_validation_failed();
    std::vector<std::uint32_t> words(receivers.size());
    std::memcpy(words.data(), copied.mapped(), words.size() * 4);
    result.push_back(std::move(words));
  }
  return result;
}

}  // namespace penumbra::tests
