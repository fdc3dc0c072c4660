#include "experiments/claims/laboratory.h"

#include "experiments/report/rows.h"
#include "renderer/error.h"

namespace penumbra::experiments::claims {

Scale full_scale() {
  return {};
}

Scale quick_scale() {
  return {120, 64, 150, 64};
}

Engine& Laboratory::engine() {
  if (!engine_) engine_ = std::make_unique<Engine>(options_);
  return *engine_;
}

const nlohmann::json& Laboratory::row(const std::string& scene, const std::string& technique,
                                      Truth truth, std::uint32_t size,
                                      std::uint32_t light_samples) {
  const NamedTechnique named = read_technique(technique);
  Run run;
  run.scene = scene;
  run.technique = named.id;
  run.parameters = named.parameters;
  run.name = technique;
  run.width = run.height = size == 0 ? scale_.size : size;
  run.light_samples = light_samples == 0 ? scale_.light_samples : light_samples;
  run.truth = truth;
  const nlohmann::json& found = row(run);
  if (!is_done(found)) {
    const nlohmann::json& error = found.at("error");
    throw Error(error.at("code"), error.at("message"), error.at("field"));
  }
  return found;
}

const nlohmann::json& Laboratory::row(const Run& run) {
  const std::string key = run.scene + " " + run.name + " " + std::to_string(run.width) + " " +
                          std::to_string(run.light_samples) + " " +
                          std::to_string(static_cast<int>(run.truth)) + " " + run.view.text();
  const auto [place, fresh] = known_.try_emplace(key, rows_.size());
  if (fresh) {
    try {
      if (before) before(run.scene + " " + run.name);
      rows_.push_back(engine().measure(run));
    } catch (...) {
      known_.erase(place);
      throw;
    }
  }
  return rows_[place->second];
}

double Laboratory::value(const char* key, const std::string& scene, const std::string& technique,
                         Truth truth, std::uint32_t size) {
  return number_of(row(scene, technique, truth, size), key);
}

RenderResult Laboratory::draw(const std::string& scene, const std::string& technique,
                              std::uint32_t size, std::uint32_t light_samples) {
  if (before) before(scene + " " + technique);
  RenderRequest request = request_of(engine().scene(scene), technique, size);
  if (light_samples != 0) request.light_samples = light_samples;
  return engine().renderer().render(request);
}

RenderResult Laboratory::draw(const std::shared_ptr<const Scene>& scene, const std::string& label,
                              const std::string& technique, std::uint32_t size,
                              const std::string& diagnostic) {
  if (before) before(label + " " + technique);
  RenderRequest request = request_of(scene, technique, size);
  request.diagnostic = diagnostic;
  return engine().renderer().render(request);
}

RenderRequest Laboratory::request_of(const std::shared_ptr<const Scene>& scene,
                                     const std::string& technique, std::uint32_t size) const {
  const NamedTechnique named = read_technique(technique);
  const auto resolved = techniques::resolve(named.id, named.parameters);
  RenderRequest request;
  request.scene = scene;
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.width = request.height = size == 0 ? scale_.size : size;
  request.light_samples = scale_.light_samples;
  request.visibility = true;
  return request;
}

void need_stencil_fragments(Laboratory& lab) {
  if (sum_over_passes(lab.row("sweep:10x1600x1", "shadow-volumes"), "volumes", "fragments") == 0.0)
    throw unsupported("this device counts no fragments in passes that write the stencil alone");
}

double mean_visibility(const RenderResult& drawn) {
  double sum = 0.0, weight = 0.0;
  for (std::uint32_t y = 0; y < drawn.visibility.height; ++y)
    for (std::uint32_t x = 0; x < drawn.visibility.width; ++x) {
      const double judged = static_cast<double>(drawn.judged.at(x, y, 0));
      sum += judged * static_cast<double>(drawn.visibility.at(x, y, 0));
      weight += judged;
    }
  return weight > 0.0 ? sum / weight : 0.0;
}

}  // namespace penumbra::experiments::claims
