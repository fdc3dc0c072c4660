#include <algorithm>
#include <chrono>
#include <cmath>
#include <list>
#include <stdexcept>

#include "renderer/error.h"
#include "renderer/frame/common_parameters.h"
#include "renderer/frame/cost_report.h"
#include "renderer/frame/light_pass.h"
#include "renderer/frame/parameter_glsl.h"
#include "renderer/frame/read_back.h"
#include "renderer/frame/scene_pass.h"
#include "renderer/frame/uncertainty.h"
#include "renderer/reference/intersector.h"
#include "renderer/render.h"
#include "renderer/scene/plan.h"

namespace penumbra {

std::span<const EmbeddedFile> embedded_renderer_shaders();

const char* renderer_version() {
  return "0.1.0";
}

namespace {

using Clock = std::chrono::steady_clock;
using vulkan::Sampling;

constexpr VkDeviceSize constants_bytes = 16u << 20;
constexpr VkFormat picture_format = VK_FORMAT_R8G8B8A8_UNORM;
constexpr VkFormat linear_format = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat visibility_format = VK_FORMAT_R32G32_SFLOAT;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void check_request(const RenderRequest& request, const vulkan::Device& device) {
  if (!request.scene || request.technique == nullptr)
    throw std::logic_error("a render needs a scene and a technique");
  const std::uint32_t largest = std::max(request.width, request.height);
  if (std::min(request.width, request.height) == 0 || largest > RenderLimits::max_size)
    throw bad_value("width",
                    "width and height must be 1 to " + std::to_string(RenderLimits::max_size));
  const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(request.supersampling)));
  if (request.supersampling != 1 && request.supersampling != 4 && request.supersampling != 16)
    throw bad_value("supersampling", "supersampling must be 1, 4 or 16");
  if (largest * side > device.properties.limits.maxImageDimension2D)
    throw bad_value("supersampling",
                    "the picture at this supersampling exceeds the device's limit of " +
                        std::to_string(device.properties.limits.maxImageDimension2D) +
                        " samples a side");
  if (request.light_samples == 0 || request.light_samples > RenderLimits::max_light_samples)
    throw bad_value("light_samples", "light_samples must be 1 to " +
                                         std::to_string(RenderLimits::max_light_samples));
  if (request.frames == 0 || request.frames > RenderLimits::max_frames)
    throw bad_value("frames", "frames must be 1 to " + std::to_string(RenderLimits::max_frames));
}

}  // namespace

/// What a device keeps between renders: compiled pipelines and the last scenes.
struct Renderer::State {
  explicit State(const RendererOptions& options)
      : device(options),
        pipelines(device, library),
        recorder(device, pipelines),
        constants(device, ledger, constants_bytes),
        faults(device, ledger, "fault counter", 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
               vulkan::MemoryKind::readback) {
    library.add(embedded_renderer_shaders());
  }

  /// The most recently used entry that `matches`, or a new one in place of the oldest.
  template <class Entry, class Matches, class Make>
  static Entry& recent(std::list<Entry>& list, const Matches& matches, const Make& make) {
    constexpr std::size_t kept = 4;
    const auto found = std::find_if(list.begin(), list.end(), matches);
    if (found != list.end()) {
      list.splice(list.begin(), list, found);
    } else {
      if (list.size() == kept) list.pop_back();
      list.push_front(make());
    }
    return list.front();
  }

  const std::vector<Bounds>& boxes_of(const std::shared_ptr<const Scene>& scene) {
    return recent(
               boxes, [&](const Boxes& entry) { return entry.scene == scene; },
               [&] {
                 return Boxes{scene, instance_boxes(*scene)};
               })
        .boxes;
  }

  const GpuScene& upload(const std::shared_ptr<const Scene>& scene, const Plan& plan) {
    return *recent(
        scenes,
        [&](const auto& entry) { return entry->serves(scene, plan.instances, plan.textures); },
        [&] { return std::make_unique<GpuScene>(device, scene, plan.instances, plan.textures); });
  }

  vulkan::Device device;
  vulkan::ShaderLibrary library;
  vulkan::MemoryLedger ledger;
  vulkan::PipelineCache pipelines;
  vulkan::Recorder recorder;
  vulkan::ConstantArena constants;
  vulkan::Buffer faults;

  struct Boxes {
    std::shared_ptr<const Scene> scene;
    std::vector<Bounds> boxes;
  };
  std::list<Boxes> boxes;  ///< most recently used first, and so are the scenes
  std::list<std::unique_ptr<GpuScene>> scenes;
};

namespace {

/// As renderer/shaders/faults.glsl has it.
struct FaultCounts {
  std::uint32_t non_finite_pixels = 0;
  std::uint32_t unfinished_invocations = 0;
};

/// The targets and passes of one render; lives for its frames.
class FrameRun {
 public:
  FrameRun(Renderer::State& state, const RenderRequest& request, const ParameterValues& parameters,
           const std::function<void(double)>& progress);
  RenderResult run();

 private:
  void draw_frame(std::uint32_t index, bool count_statistics);
  vulkan::Bindings frame_bindings(std::uint32_t index);
  void resolve(const vulkan::Bindings& bindings);
  void resolve_visibility(const vulkan::Bindings& bindings, std::uint32_t light);
  vulkan::Image make_target(const char* name, VkFormat format, std::uint32_t width,
                            std::uint32_t height, std::uint32_t layers = 1);
  void read_results(RenderResult& result);
  /// The first that reaches anything visible, or the number of lights.
  std::size_t first_light() const {
    return static_cast<std::size_t>(std::find(plan_.lights.begin(), plan_.lights.end(), true) -
                                    plan_.lights.begin());
  }
  FaultCounts fault_counts() const;
  bool tells_uncertainty() const;
  void read_uncertainty(RenderResult& result);
  void add_shared_memory(vulkan::MemoryLedger& memory) const;

  Renderer::State& state_;
  const RenderRequest& request_;
  Plan plan_;
  const std::function<void(double)>& progress_;
  Clock::time_point start_ = Clock::now();
  FrameSetup setup_;
  std::vector<std::unique_ptr<LightPass>> lights_;
  vulkan::MemoryLedger targets_ledger_;
  std::unique_ptr<Uncertainty> uncertainty_;
  GeometryBuffer geometry_;
  vulkan::Image picture_, linear_, light_sum_, visibility_samples_, visibility_, diagnostic_;
  std::uint32_t frames_total_ = 1;
  std::uint32_t frame_ = 0;
  CostReport costs_;
  std::vector<std::string> notes_;
};

FrameRun::FrameRun(Renderer::State& state, const RenderRequest& request,
                   const ParameterValues& parameters, const std::function<void(double)>& progress)
    : state_(state),
      request_(request),
      plan_(make_plan(request, parameters, state.boxes_of(request.scene))),
      progress_(progress),
      setup_{request,
             parameters,
             state.upload(request.scene, plan_),
             request.scene->cameras[find_camera(*request.scene, request.camera)],
             {},
             1,
             0,
             0,
             {}} {
  setup_.side = static_cast<std::uint32_t>(std::lround(std::sqrt(request.supersampling)));
  setup_.width = request.width * setup_.side;
  setup_.height = request.height * setup_.side;
  const glm::vec3 extent = setup_.scene.high() - setup_.scene.low();
  setup_.matrices = camera_matrices(setup_.camera, setup_.scene.origin(),
                                    static_cast<double>(request.width) / request.height,
                                    0.5 * static_cast<double>(glm::length(extent)));
  setup_.declarations = parameter_declarations(request.technique->parameters, parameters);

  bool stencil = false;
  bool many_points = false;
  for (std::size_t i = 0; i < plan_.lights.size(); ++i) {
    lights_.push_back(nullptr);
    if (!plan_.lights[i]) continue;
    lights_.back() = std::make_unique<LightPass>(setup_, request.scene->lights[i]);
    stencil = stencil || lights_.back()->needs().stencil;
    many_points = many_points || lights_.back()->needs().light_points > 1;
  }
  if (!request.diagnostic.empty() && first_light() == lights_.size())
    throw unsupported("no light reaches what the camera sees: there is nothing to show",
                      "diagnostic");
  geometry_ =
      make_geometry_buffer(state.device, targets_ledger_, setup_.width, setup_.height, stencil);
  picture_ = make_target("picture", picture_format, request.width, request.height);
  if (many_points)
    light_sum_ = make_target("light sums", linear_format, setup_.width, setup_.height);
  for (const auto& light : lights_)
    if (light && light->needs().scrambles && !request.diagnostic.empty() && !tells_uncertainty())
      throw unsupported("the error of this picture is not known: that takes a multiple of 16 light "
                        "samples for each sample of a pixel, and no more than " +
                            std::to_string(Uncertainty::max_pixels) + " pixels",
                        "light_samples");
  if (tells_uncertainty())
    uncertainty_ = std::make_unique<Uncertainty>(state.device, targets_ledger_, request.width,
                                                 request.height, setup_.side);
  if (request.linear || uncertainty_)
    linear_ = make_target("linear picture", linear_format, request.width, request.height);
  if (request.visibility && !lights_.empty()) {
    visibility_samples_ =
        make_target("visibility samples", visibility_format, setup_.width, setup_.height);
    visibility_ = make_target("visibility", visibility_format, request.width, request.height,
                              static_cast<std::uint32_t>(lights_.size()));
  }
  if (!request.diagnostic.empty())
    diagnostic_ = make_target("diagnostic", picture_format, setup_.width, setup_.height);
}

vulkan::Image FrameRun::make_target(const char* name, VkFormat format, std::uint32_t width,
                                    std::uint32_t height, std::uint32_t layers) {
  vulkan::ImageDescription description;
  description.format = format;
  description.width = width;
  description.height = height;
  description.layers = layers;
  description.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                      VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  if (format == linear_format) description.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
  return {state_.device, targets_ledger_, name, description};
}

vulkan::Bindings FrameRun::frame_bindings(std::uint32_t index) {
  const Scene& scene = *request_.scene;
  const CameraMatrices& m = setup_.matrices;
  shader::FrameData frame{};
  frame.clip_from_world = m.clip_from_world;
  frame.world_from_clip = m.world_from_clip;
  frame.camera_position =
      glm::vec4(m.position, setup_.camera.projection == Projection::perspective ? 1.0 : 0.0);
  frame.camera_direction = glm::vec4(m.direction, setup_.camera.near_plane);
  frame.ambient = glm::vec4(scene.ambient, 0.0f);
  frame.background_low = glm::vec4(scene.background_low, 0.0f);
  frame.background_high = glm::vec4(scene.background_high, 0.0f);
  frame.size = glm::vec4(setup_.width, setup_.height, setup_.side, scene.exposure);
  const GammaTreatment gamma = gamma_treatment(setup_.parameters);
  frame.options = {static_cast<std::uint32_t>(gamma.decodes), index,
                   static_cast<std::uint32_t>(request_.seed), gamma.encodes ? 1u : 0u};
  const auto words = parameter_block(request_.technique->parameters, setup_.parameters);
  vulkan::Bindings bindings;
  bindings.buffer("FrameBlock", state_.constants.push(frame));
  bindings.buffer("ParameterBlock",
                  state_.constants.push_array(std::span<const std::uint32_t>(words)));
  bindings.buffer("MaterialBlock", setup_.scene.material_buffer().whole());
  bindings.buffer("FaultBlock", state_.faults.whole());
  bindings.texture("geometry_position", geometry_.position, Sampling::nearest);
  bindings.texture("geometry_words", geometry_.words, Sampling::nearest);
  return bindings;
}

void FrameRun::draw_frame(std::uint32_t index, bool count_statistics) {
  state_.constants.reset();
  std::memset(state_.faults.mapped(), 0, state_.faults.size());
  state_.recorder.clear_records();
  const vulkan::Bindings bindings = frame_bindings(index);
  if (uncertainty_) uncertainty_->begin_frame();
  state_.recorder.begin(count_statistics);
  state_.recorder.pass("geometry", [&](vulkan::Commands& commands) {
    draw_geometry(commands, state_.pipelines, setup_.scene, geometry_, bindings,
                  glm::mat4(setup_.matrices.clip_from_world));
  });
  for (std::uint32_t i = 0; i < lights_.size(); ++i) {
    if (!lights_[i]) continue;
    const LightPass::Frame frame{state_.device,
                                 state_.pipelines,
                                 state_.library,
                                 state_.recorder,
                                 state_.constants,
                                 geometry_,
                                 request_.visibility ? &visibility_samples_ : nullptr,
                                 &light_sum_,
                                 uncertainty_.get(),
                                 bindings,
                                 index,
                                 notes_};
    const bool long_light = lights_[i]->needs().light_points > 1;
    lights_[i]->draw(frame, [&](double share) {
      if (long_light && progress_)
        progress_((frame_ + (i + share) / static_cast<double>(lights_.size())) / frames_total_);
    });
    if (request_.visibility) resolve_visibility(bindings, i);
    if (!request_.diagnostic.empty() && i == first_light())
      lights_[i]->draw_diagnostic(frame, request_.diagnostic, diagnostic_);
  }
  resolve(bindings);
  state_.recorder.end();
  if (fault_counts().unfinished_invocations > 0)
    throw device_error("loops of " + std::to_string(fault_counts().unfinished_invocations) +
                       " shader invocations ended before their work was done");
}

/// Asked for, or shown by the technique's own picture, and known.
bool FrameRun::tells_uncertainty() const {
  if (!request_.uncertainty && request_.diagnostic.empty()) return false;
  if (std::uint64_t{request_.width} * request_.height > Uncertainty::max_pixels) return false;
  return std::all_of(lights_.begin(), lights_.end(),
                     [](const auto& light) { return !light || light->tells_error(); });
}

void FrameRun::read_uncertainty(RenderResult& result) {
  const ImageF linear = read_float(state_.device, linear_, 4);
  result.uncertainty = uncertainty_->standard_error(linear, request_.scene->exposure,
                                                    gamma_treatment(setup_.parameters).encodes);
  result.noise_rms_y = root_mean_square(result.uncertainty);
}

FaultCounts FrameRun::fault_counts() const {
  FaultCounts counts;
  std::memcpy(&counts, state_.faults.mapped(), sizeof(counts));
  return counts;
}

void FrameRun::resolve(const vulkan::Bindings& bindings) {
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                   {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shaders/resolve.frag"}};
  vulkan::GraphicsState state;
  state.color_formats = {picture_format};
  vulkan::RenderTargets targets{request_.width, request_.height, {{picture_.slice(0), false, {}}}};
  if (linear_) {
    source.preamble = "#define WITH_LINEAR\n";
    state.color_formats.push_back(linear_format);
    targets.colors.push_back({linear_.slice(0), false, {}});
  }
  vulkan::Bindings all = bindings;
  all.texture("radiance", geometry_.radiance, Sampling::nearest);
  const vulkan::Pipeline& pipeline = state_.pipelines.graphics(source, state);
  state_.recorder.pass("resolve", [&](vulkan::Commands& commands) {
    commands.begin_rendering(targets);
    commands.bind(pipeline, all);
    commands.full_screen_triangle();
    commands.end_rendering();
  });
}

void FrameRun::resolve_visibility(const vulkan::Bindings& bindings, std::uint32_t light) {
  vulkan::ProgramSource source;
  source.stages = {{VK_SHADER_STAGE_VERTEX_BIT, "renderer/shaders/full_screen.vert"},
                   {VK_SHADER_STAGE_FRAGMENT_BIT, "renderer/shaders/resolve_visibility.frag"}};
  vulkan::GraphicsState state;
  state.color_formats = {visibility_format};
  vulkan::Bindings all = bindings;
  all.texture("visibility_samples", visibility_samples_, Sampling::nearest);
  const vulkan::Pipeline& pipeline = state_.pipelines.graphics(source, state);
  state_.recorder.pass("resolve visibility", [&](vulkan::Commands& commands) {
    commands.begin_rendering(
        {request_.width, request_.height, {{visibility_.slice(light), false, {}}}});
    commands.bind(pipeline, all);
    commands.full_screen_triangle();
    commands.end_rendering();
  });
}

RenderResult FrameRun::run() {
  // One frame alone is both warm-up and picture; with more, the first is drawn to compile shaders
  // and to count, and the others are timed without counters.
  const std::uint32_t warm_up = request_.frames > 1 ? 1 : 0;
  frames_total_ = warm_up + request_.frames;
  double create_ms = 0.0;
  for (frame_ = 0; frame_ < frames_total_; ++frame_) {
    draw_frame(frame_, frame_ == 0);
    costs_.add(state_.recorder.records(), state_.recorder.wall_ms(), frame_ >= warm_up);
    if (frame_ == 0) create_ms = ms_since(start_);
    if (progress_) progress_(static_cast<double>(frame_ + 1) / frames_total_);
  }
  RenderResult result;
  result.cost = costs_.summary();
  result.cost.create_ms = create_ms;
  read_results(result);
  state_.device.throw_if_validation_failed();
  return result;
}

void FrameRun::read_results(RenderResult& result) {
  result.picture = read_rgba8(state_.device, picture_);
  if (request_.linear) result.linear = read_float(state_.device, linear_, 4);
  for (const auto& light : request_.scene->lights) result.light_names.push_back(light.name);
  const auto lights = static_cast<std::uint32_t>(lights_.size());
  if (request_.visibility && lights > 0) {
    result.visibility = ImageF(request_.width, request_.height, lights);
    result.judged = result.visibility;
    std::fill(result.visibility.pixels.begin(), result.visibility.pixels.end(), 1.0f);
    for (std::uint32_t i = 0; i < lights; ++i) {
      if (!lights_[i]) continue;  // reaches no pixel: visible where not judged, judged nowhere
      const ImageF pair = read_float(state_.device, visibility_, 2, i);
      for (std::size_t p = 0; p < pair.pixel_count(); ++p) {
        result.visibility.pixels[p * lights + i] = pair.pixels[2 * p];
        result.judged.pixels[p * lights + i] = pair.pixels[2 * p + 1];
      }
    }
  }
  if (uncertainty_ && request_.uncertainty) read_uncertainty(result);
  if (diagnostic_) result.diagnostic = read_rgba8(state_.device, diagnostic_);
  result.non_finite_pixels = fault_counts().non_finite_pixels;
  vulkan::MemoryLedger memory;
  for (const auto& light : lights_)
    if (light)
      for (const ResourceCost& resource : light->memory())
        memory.add(resource.name, resource.bytes);
  add_shared_memory(memory);
  result.cost.technique_memory = memory.entries;
  std::sort(notes_.begin(), notes_.end());
  notes_.erase(std::unique(notes_.begin(), notes_.end()), notes_.end());
  result.notes = notes_;
  if (result.non_finite_pixels > 0)
    result.notes.push_back(std::to_string(result.non_finite_pixels) +
                           " pixels are not finite (magenta)");
}

/// What lights require together is there once, however many they are.
void FrameRun::add_shared_memory(vulkan::MemoryLedger& memory) const {
  bool stencil = false;
  bool adjacency = false;
  bool acceleration = false;
  for (const auto& light : lights_) {
    if (!light) continue;
    stencil = stencil || light->needs().stencil;
    adjacency = adjacency || light->needs().adjacency;
    acceleration = acceleration || light->needs().acceleration_structure;
  }
  if (acceleration)
    for (const ResourceCost& part :
         reference::Intersector::of(state_.device, setup_.scene).memory())
      memory.add(part.name, part.bytes);
  if (adjacency) memory.add("adjacency", setup_.scene.adjacency(state_.device).indices.size());
  for (const ResourceCost& target : targets_ledger_.entries)
    if (target.name == "light sums") memory.add(target.name, target.bytes);
  if (!stencil) return;
  // A format with stencil may hold padding too: all that it takes over depth alone is the price.
  const std::uint64_t depth_bytes = std::uint64_t{setup_.width} * setup_.height * sizeof(float);
  for (const ResourceCost& target : targets_ledger_.entries)
    if (target.name == "geometry depth and stencil" && target.bytes > depth_bytes)
      memory.add("stencil", target.bytes - depth_bytes);
}

}  // namespace

Renderer::Renderer(const RendererOptions& options) : state(std::make_unique<State>(options)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const DeviceInfo& Renderer::device() const {
  return state->device.info;
}

RenderResult Renderer::render(const RenderRequest& request,
                              const std::function<void(double)>& progress) {
  check_request(request, state->device);
  validate(*request.scene);
  if (!request.diagnostic.empty()) {
    std::string names;
    bool known = false;
    for (const Diagnostic& diagnostic : request.technique->diagnostics) {
      known = known || diagnostic.name == request.diagnostic;
      names += (names.empty() ? "" : ", ") + diagnostic.name;
    }
    if (!known)
      throw bad_value("diagnostic", request.technique->id + " has no diagnostic picture " +
                                        request.diagnostic +
                                        (names.empty() ? "" : "; there are: " + names));
  }
  const ParameterValues parameters =
      complete_parameters(request.technique->parameters, request.parameters);
  state->library.add(request.technique->files);
  return FrameRun(*state, request, parameters, progress).run();
}

}  // namespace penumbra
