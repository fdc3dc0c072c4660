#include "experiments/stability/drawing.h"

#include <chrono>

#include "renderer/error.h"
#include "scenes/library.h"
#include "techniques/parameter_schema.h"

namespace penumbra::experiments::stability {
namespace {

std::string size_text(const Trial& trial) {
  return std::to_string(trial.width) + "x" + std::to_string(trial.height) + "x" +
         std::to_string(trial.points);
}

/// Light points asked of techniques that take many: enough that their noise is far below what
/// counts as broken.
std::uint32_t light_samples(const Trial& trial) {
  return std::max(64u, trial.points);
}

RenderRequest request_of(const techniques::Resolved& technique, const Trial& trial) {
  RenderRequest request;
  request.scene = std::make_shared<const Scene>(trial.scene);
  request.technique = technique.technique;
  request.parameters = technique.parameters;
  for (const auto& [name, value] : trial.parameters) request.parameters[name] = value;
  request.width = trial.width;
  request.height = trial.height;
  request.light_samples = light_samples(trial);
  request.visibility = true;
  request.linear = true;
  return request;
}

}  // namespace

std::string request_key(const techniques::Resolved& technique, const Trial& trial) {
  ParameterValues parameters = technique.parameters;
  for (const auto& [name, value] : trial.parameters) parameters[name] = value;
  return technique.technique->id + " " + techniques::values_to_json(parameters).dump() + " " +
         scenes::content_hash(trial.scene) + " " + size_text(trial);
}

const Truth& Drawing::truth_of(const Trial& trial) {
  const Scene& scene = trial.unmoved ? *trial.unmoved : trial.scene;
  const std::string key = scenes::content_hash(scene) + " " + size_text(trial);
  const auto known = truths_.find(key);
  if (known != truths_.end()) return known->second;
  return truths_.emplace(key, judge(scene, trial.width, trial.height, trial.points)).first->second;
}

Step Drawing::draw(const techniques::Resolved& technique, const Trial& trial, double value) {
  Step step;
  step.value = value;
  const auto start = std::chrono::steady_clock::now();
  try {
    validate(trial.scene);
    const RenderResult result = renderer_.render(request_of(technique, trial));
    step.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    step.notes = result.notes;
    step.verdict = compare(truth_of(trial), trial.scene, result);
  } catch (const Error& error) {
    step.code = error.code;
    step.field = error.field;
    step.message = error.what();
    // A device's own words name nothing that a user could change.
    step.state = error.code == "device" && error.field.empty() ? State::opaque : State::refused;
  } catch (const std::exception& error) {
    step.message = error.what();
    step.state = State::opaque;
  }
  return step;
}

}  // namespace penumbra::experiments::stability
