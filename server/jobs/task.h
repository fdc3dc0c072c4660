#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "renderer/render.h"
#include "server/jobs/canonical_request.h"
#include "server/jobs/checkpoint.h"
#include "server/jobs/message.h"

namespace penumbra::server {

/// What a render can be asked for besides its picture; names as in a task's `wants`.
namespace want {
inline constexpr auto image = "image.png";
inline constexpr auto linear = "image.exr";
inline constexpr auto visibility = "visibility.exr";
inline constexpr auto error_map = "error.png";
inline constexpr auto cost = "cost";
inline constexpr auto quality = "quality";
inline constexpr auto noise = "noise";  ///< of a reference: how far it is from converged
}  // namespace want

/// Names of files that a render may have, in a stable order.
const std::vector<std::string>& artefact_names();

/// True where what is wanted is judged against the reference: `quality`, `error.png`.
bool needs_reference(const std::set<std::string>& wants);

/// The reference that a picture is judged against.
struct ReferencePictures {
  std::string id;
  std::string image;           ///< PNG
  std::string visibility;      ///< EXR
  nlohmann::json noise_rms_y;  ///< null where unknown
};

/// One piece of work for a renderer.
struct Task {
  CanonicalRequest request;
  std::set<std::string> wants;
  ReferencePictures reference;  ///< read where needs_reference(wants)
  CheckpointFolder checkpoints;
};

struct TaskResult {
  Blobs artefacts;
  nlohmann::json cost;         ///< as in the contract; null unless wanted
  nlohmann::json quality;      ///< as in the contract; null unless wanted
  nlohmann::json noise_rms_y;  ///< null unless wanted
  std::vector<std::string> notes;
};

/// Draws, measures and encodes. `progress` gets 0..1.
TaskResult run_task(Renderer& renderer, const Task& task,
                    const std::function<void(double)>& progress);

nlohmann::json device_to_json(const DeviceInfo& device);

}  // namespace penumbra::server
