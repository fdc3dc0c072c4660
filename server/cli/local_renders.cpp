#include "server/cli/local_renders.h"

#include <unistd.h>

#include <cstdlib>

#include "renderer/error.h"

namespace penumbra::server::cli {
namespace {

using nlohmann::json;

constexpr std::uint64_t cache_bytes = std::uint64_t{2} << 30;
constexpr double reference_part = 0.6;  ///< of the bar

CheckpointFolder checkpoints() {
  return {checkpoint_folder(cache_folder()), CheckpointFolder{}.every_s};
}

}  // namespace

std::filesystem::path cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && *cache == '/') return std::filesystem::path(cache) / "penumbra";
  const char* home = std::getenv("HOME");
  if (home && *home == '/') return std::filesystem::path(home) / ".cache" / "penumbra";
  return std::filesystem::temp_directory_path() / ("penumbra-" + std::to_string(::getuid()));
}

LocalRenders::LocalRenders(const RequestContext& context, bool validation)
    : context_(context),
      renderer_(RendererOptions{context.device, validation}),
      references_(cache_folder() / "references", cache_bytes) {
  sweep_checkpoints(checkpoint_folder(cache_folder()));
}

ReferencePictures LocalRenders::reference_for(const CanonicalRequest& request,
                                              const std::function<void(double)>& progress) {
  const CanonicalRequest reference = reference_of(request, context_);
  const json device = device_to_json(renderer_.device());
  const json record = references_.find(reference.id);
  if (!record.is_null() && record.at("device") == device) {
    const auto image = references_.read(reference.id, want::image);
    const auto visibility = references_.read(reference.id, want::visibility);
    if (image && visibility) return {reference.id, *image, *visibility, record.at("noise_rms_y")};
  }
  TaskResult drawn = run_task(
      renderer_, {reference, {want::image, want::visibility, want::noise}, {}, checkpoints()},
      progress);
  references_.put(reference.id, {{"device", device}, {"noise_rms_y", drawn.noise_rms_y}},
                  drawn.artefacts);
  return {reference.id, std::move(drawn.artefacts[want::image]),
          std::move(drawn.artefacts[want::visibility]), drawn.noise_rms_y};
}

LocalRenders::Outcome LocalRenders::render(const CanonicalRequest& request,
                                           const std::set<std::string>& wants,
                                           const std::function<void(double)>& progress) {
  Task task{request, wants, {}, checkpoints()};
  double from = 0.0;
  if (needs_reference(wants)) {
    from = reference_part;
    task.reference =
        reference_for(request, [&](double value) { progress(value * reference_part); });
  }
  TaskResult result =
      run_task(renderer_, task, [&](double value) { progress(from + (1.0 - from) * value); });
  Outcome outcome;
  outcome.record.id = request.id;
  outcome.record.status = "done";
  outcome.record.progress = 1.0;
  outcome.record.request = request.request;
  outcome.record.device = device_to_json(renderer_.device());
  outcome.record.cost = result.cost;
  outcome.record.quality = result.quality;
  outcome.record.notes = std::move(result.notes);
  outcome.artefacts = std::move(result.artefacts);
  return outcome;
}

}  // namespace penumbra::server::cli
