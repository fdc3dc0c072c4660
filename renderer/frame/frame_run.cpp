#include "renderer/frame/frame_run.h"

#include <algorithm>

#include "renderer/error.h"
#include "renderer/frame/common_parameters.h"
#include "renderer/frame/host_copy.h"
#include "renderer/frame/parameter_glsl.h"
#include "renderer/frame/scene_pass.h"
#include "renderer/plan/memory_check.h"

namespace penumbra {
namespace {

using vulkan::Sampling;

CameraMatrices picture_matrices(const RenderRequest& request, const GpuScene& scene,
                                const Camera& camera) {
  const double aspect = static_cast<double>(request.width) / request.height;
  std::vector<Bounds> boxes;
  for (const DrawRange& range : scene.ranges())
    if (range.visible) boxes.push_back(range.box());
  return matrices_seeing(camera, scene.origin(), aspect, boxes);
}

FrameSetup make_setup(Renderer::State& state, const RenderRequest& request,
                      const ParameterValues& parameters, const Plan& plan, const Window& window) {
  const Camera& camera = request.scene->cameras[find_camera(*request.scene, request.camera)];
  const GpuScene& scene = state.upload(request.scene, camera, plan);
  return {request,
          parameters,
          scene,
          camera,
          picture_matrices(request, scene, camera),
          {},
          samples_per_side(request.supersampling),
          window,
          parameter_declarations(request.technique->parameters, parameters)};
}

Plan checked(Plan plan, const DeviceLimits& limits) {
  check_memory(plan, limits);
  return plan;
}

std::vector<std::unique_ptr<LightPass>> make_lights(const FrameSetup& setup,
                                                    const Bounds& scene_box, const Plan& plan) {
  std::vector<std::unique_ptr<LightPass>> lights;
  for (std::size_t i = 0; i < plan.lights.size(); ++i)
    lights.push_back(plan.lights[i]
                         ? std::make_unique<LightPass>(setup, scene_box,
                                                       setup.request.scene->lights[i], plan.fits[i])
                         : nullptr);
  return lights;
}

/// Whether any light that is drawn requires it.
template <class Needs>
bool any(const std::vector<std::unique_ptr<LightPass>>& lights, const Needs& needs) {
  return std::any_of(lights.begin(), lights.end(),
                     [&](const auto& light) { return light && needs(light->needs()); });
}

bool has_many_points(const Requirements& needs) {
  return needs.light_points > 1;
}

}  // namespace

FrameRun::FrameRun(Renderer::State& state, const RenderRequest& request,
                   const ParameterValues& parameters, const Window& window, bool in_rounds)
    : state_(state),
      request_(request),
      plan_(checked(make_plan(request, parameters, state.boxes_of(request.scene)),
                    state.device.limits())),
      setup_(make_setup(state, request, parameters, plan_, window)),
      lights_(make_lights(setup_, around(state.boxes_of(request.scene)), plan_)),
      targets_(state.device, window, setup_.side, wanted_targets(in_rounds)) {}

void FrameRun::look_through(const Camera& camera) {
  const Plan plan =
      make_plan(request_, setup_.parameters, state_.boxes_of(request_.scene), &camera);
  // Lights' passes hold on to their fits.
  std::copy(plan.fits.begin(), plan.fits.end(), plan_.fits.begin());
  setup_.camera = camera;
  setup_.picture_matrices = picture_matrices(request_, setup_.scene, camera);
  notes_.clear();
}

FrameTargets::Wanted FrameRun::wanted_targets(bool in_rounds) const {
  if (!request_.diagnostic.empty() && first_light() == lights_.size())
    throw unsupported("no light reaches what the camera sees: there is nothing to show",
                      "diagnostic");
  check_uncertainty();
  FrameTargets::Wanted wanted;
  wanted.stencil = any(lights_, [](const Requirements& needs) { return needs.stencil; });
  wanted.emitted = setup_.scene.emits();
  wanted.radiance = !light_finishes();
  wanted.light_sums = any(lights_, has_many_points);
  wanted.uncertainty =
      (request_.uncertainty || request_.error_bound > 0.0 || draws_uncertainty()) &&
      knows_uncertainty();
  wanted.linear = request_.linear || wanted.uncertainty || in_rounds;
  wanted.diagnostic = !request_.diagnostic.empty();
  if (request_.visibility) wanted.visibility_layers = static_cast<std::uint32_t>(lights_.size());
  return wanted;
}

bool FrameRun::draws_uncertainty() const {
  const Diagnostic* diagnostic = find_diagnostic(*request_.technique, request_.diagnostic);
  return diagnostic != nullptr && diagnostic->of_uncertainty;
}

bool FrameRun::knows_uncertainty() const {
  return std::uint64_t{request_.width} * request_.height <= Uncertainty::max_pixels &&
         std::all_of(lights_.begin(), lights_.end(),
                     [](const auto& light) { return !light || light->tells_error(); });
}

void FrameRun::check_uncertainty() const {
  const bool bounded = request_.error_bound > 0.0;
  if ((!draws_uncertainty() && !bounded) || knows_uncertainty()) return;
  // Techniques without scrambles say nothing of their error; a bound on it does not concern them.
  if (!any(lights_, [](const Requirements& needs) { return needs.scrambles; })) return;
  throw unsupported(
      "the error of this picture is not known: that takes a multiple of 16 light "
      "samples for each sample of a pixel, and no more than " +
          std::to_string(Uncertainty::max_pixels) + " pixels",
      bounded ? "error_bound" : "light_samples");
}

std::size_t FrameRun::first_light() const {
  return static_cast<std::size_t>(std::find(plan_.lights.begin(), plan_.lights.end(), true) -
                                  plan_.lights.begin());
}

vulkan::Bindings FrameRun::frame_bindings() {
  const Scene& scene = *request_.scene;
  const CameraMatrices& m = setup_.matrices;
  const auto side = static_cast<float>(setup_.side);
  shader::FrameData frame{};
  frame.clip_from_world = m.clip_from_world;
  frame.world_from_clip = m.world_from_clip;
  frame.camera_position =
      glm::vec4(m.position, setup_.camera.projection == Projection::perspective ? 1.0 : 0.0);
  frame.camera_direction = glm::vec4(m.direction, m.near_plane);
  frame.ambient = glm::vec4(scene.ambient, setup_.scene.inverse_size());
  frame.background_low = glm::vec4(scene.background_low, 0.0f);
  frame.background_high = glm::vec4(scene.background_high, 0.0f);
  frame.size = glm::vec4(setup_.width(), setup_.height(), setup_.side, exposure_factor(request_));
  frame.window =
      side * glm::vec4(setup_.window.x, setup_.window.y, request_.width, request_.height);
  const GammaTreatment gamma = gamma_treatment(setup_.parameters);
  frame.pixel =
      glm::vec4(glm::dvec3(m.world_from_clip[0]) * (2.0 / static_cast<double>(setup_.width())),
                gamma.encodes ? 1.0 : 0.0);
  const auto words = parameter_block(request_.technique->parameters, setup_.parameters);
  vulkan::Bindings bindings;
  bindings.buffer("FrameBlock", state_.constants.push(frame));
  bindings.buffer("ParameterBlock",
                  state_.constants.push_array(std::span<const std::uint32_t>(words)));
  bindings.buffer("MaterialBlock", setup_.scene.material_buffer().whole());
  bindings.buffer("FaultBlock", state_.faults.whole());
  bindings.texture("geometry_position", targets_.geometry.position, Sampling::nearest);
  bindings.texture("geometry_words", targets_.geometry.words, Sampling::nearest);
  if (targets_.geometry.emitted)
    bindings.texture("geometry_emitted", targets_.geometry.emitted, Sampling::nearest);
  return bindings;
}

void FrameRun::draw(const Window& window, PointRange round, std::uint32_t index,
                    bool count_statistics, const std::function<void(double)>& progress) {
  setup_.window = window;
  setup_.matrices =
      camera_of_window(setup_.picture_matrices, window, request_.width, request_.height);
  for (const auto& light : lights_)
    if (light) light->choose_points(round);
  state_.constants.reset();
  std::memset(state_.faults.mapped(), 0, state_.faults.size());
  const vulkan::Bindings bindings = frame_bindings();
  if (uncertainty() != nullptr) uncertainty()->begin_round(round.count);
  state_.recorder.begin(count_statistics);
  state_.recorder.pass("geometry", [&](vulkan::Commands& commands) {
    draw_geometry(commands, state_.pipelines, setup_.scene, targets_.geometry, bindings,
                  glm::mat4(setup_.matrices.clip_from_world), gamma_treatment(setup_.parameters),
                  reads_sky());
  });
  draw_lights(bindings, index, progress);
  resolve(bindings);
  state_.recorder.end();
  std::uint32_t unfinished = 0;  // renderer/shaders/faults.glsl
  std::memcpy(&unfinished, state_.faults.mapped(), sizeof(unfinished));
  if (unfinished > 0)
    throw device_error("loops of " + std::to_string(unfinished) +
                       " shader invocations ended before their work was done");
}

/// What shades and finishes lies behind the depth test.
bool FrameRun::reads_sky() const {
  if (!light_finishes() || request_.visibility || !request_.diagnostic.empty()) return true;
  return any(lights_, [](const Requirements& needs) { return needs.reads_sky; }) ||
         any(lights_, has_many_points);
}

void FrameRun::draw_lights(const vulkan::Bindings& bindings, std::uint32_t index,
                           const std::function<void(double)>& progress) {
  for (std::uint32_t i = 0; i < lights_.size(); ++i) {
    if (!lights_[i]) continue;
    LightPass& light = *lights_[i];
    const LightPass::Frame frame{state_.device,
                                 state_.pipelines,
                                 state_.shaders,
                                 state_.recorder,
                                 state_.constants,
                                 targets_.geometry,
                                 light_output(i == first_light()),
                                 &targets_.light_sums,
                                 uncertainty(),
                                 bindings,
                                 index,
                                 notes_};
    light.draw(frame, [&](double share) {
      if (progress && has_many_points(light.needs()))
        progress((i + share) / static_cast<double>(lights_.size()));
    });
    if (request_.visibility) resolve_visibility(bindings, i);
    if (!request_.diagnostic.empty() && i == first_light())
      light.draw_diagnostic(frame, request_.diagnostic, targets_.diagnostic);
  }
}

std::vector<std::string> FrameRun::notes() const {
  std::vector<std::string> notes = notes_;
  notes.insert(notes.end(), setup_.scene.notes().begin(), setup_.scene.notes().end());
  std::sort(notes.begin(), notes.end());
  notes.erase(std::unique(notes.begin(), notes.end()), notes.end());
  return notes;
}

std::vector<ResourceCost> FrameRun::technique_memory() const {
  vulkan::MemoryLedger memory;
  for (const auto& light : lights_)
    if (light)
      for (const ResourceCost& resource : light->memory())
        memory.add(resource.name, resource.bytes);
  // What lights require together is there once, however many they are.
  if (any(lights_, [](const Requirements& needs) { return needs.acceleration_structure; }))
    for (const ResourceCost& part : setup_.scene.derived_memory(acceleration_structure_name))
      memory.add(part.name, part.bytes);
  if (any(lights_, [](const Requirements& needs) { return needs.adjacency; }))
    memory.add("adjacency", setup_.scene.adjacency(state_.device).indices.size());
  const bool stencil = any(lights_, [](const Requirements& needs) { return needs.stencil; });
  // A format with stencil may hold padding too: all that it takes over depth alone is the price.
  const std::uint64_t depth_bytes = std::uint64_t{setup_.width()} * setup_.height() * sizeof(float);
  for (const ResourceCost& target : targets_.ledger.entries) {
    if (target.name == "light sums") memory.add(target.name, target.bytes);
    if (stencil && target.name == "geometry depth and stencil" && target.bytes > depth_bytes)
      memory.add("stencil", target.bytes - depth_bytes);
  }
  return memory.entries;
}

}  // namespace penumbra
