#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "server/jobs/artefact_store.h"
#include "server/jobs/render_service.h"
#include "server/jobs/task.h"

namespace penumbra::server::cli {

/// Renders within this process, for commands that draw one thing. References are kept in the user's
/// cache folder, since measuring many techniques needs each of them many times.
class LocalRenders {
 public:
  LocalRenders(const RequestContext& context, bool validation);

  struct Outcome {
    RenderRecord record;
    Blobs artefacts;
  };
  Outcome render(const CanonicalRequest& request, const std::set<std::string>& wants,
                 const std::function<void(double)>& progress);

  const DeviceInfo& device() const { return renderer_.device(); }

 private:
  ReferencePictures reference_for(const CanonicalRequest& request,
                                  const std::function<void(double)>& progress);

  RequestContext context_;
  Renderer renderer_;
  ArtefactStore references_;
};

/// $XDG_CACHE_HOME/penumbra or ~/.cache/penumbra.
std::filesystem::path cache_folder();

}  // namespace penumbra::server::cli
