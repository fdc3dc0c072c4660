#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiments/engine/engine.h"

namespace penumbra::experiments::claims {

/// How large the pictures of claims are. The quick ones answer in minutes on two cores.
struct Scale {
  std::uint32_t size = 300;           ///< pixels along an edge
  std::uint32_t light_samples = 256;  ///< of the reference
  std::uint32_t survey_size = 600;    ///< of the six scenes, as published
  std::uint32_t survey_samples = 1024;
};
Scale full_scale();
Scale quick_scale();

/// What claims measure with. The device is made when the first picture is asked for: claims about
/// published tables need none.
class Laboratory {
 public:
  Laboratory(EngineOptions options, Scale scale) : options_(std::move(options)), scale_(scale) {}

  /// The engine's row of a technique, written ID[:NAME=VALUE]...; size 0: the scale's. Throws the
  /// technique's Error where it refuses the scene.
  const nlohmann::json& row(const std::string& scene, const std::string& technique,
                            Truth truth = Truth::none, std::uint32_t size = 0,
                            std::uint32_t light_samples = 0);
  /// The engine's row of a run, also of one that failed. Its name must tell its technique and its
  /// parameters; runs that differ in more than that, scene, size, samples, truth and view are not
  /// told apart.
  const nlohmann::json& row(const Run& run);
  /// A number of that row.
  double value(const char* key, const std::string& scene, const std::string& technique,
               Truth truth = Truth::none, std::uint32_t size = 0);
  /// A picture with its visibility, which is not kept.
  RenderResult draw(const std::string& scene, const std::string& technique, std::uint32_t size = 0,
                    std::uint32_t light_samples = 0);

  /// The same of a scene made here; `label` tells what is drawn.
  RenderResult draw(const std::shared_ptr<const Scene>& scene, const std::string& label,
                    const std::string& technique, std::uint32_t size = 0,
                    const std::string& diagnostic = {});

  const Scale& scale() const { return scale_; }
  /// What `draw` draws, with visibility.
  RenderRequest request_of(const std::shared_ptr<const Scene>& scene, const std::string& technique,
                           std::uint32_t size = 0) const;

  Engine& engine();
  bool has_engine() const { return engine_ != nullptr; }
  /// All rows, in the order in which they were first asked for.
  const std::vector<nlohmann::json>& rows() const { return rows_; }
  /// Called before every picture with what is drawn. May throw, which ends the claims.
  std::function<void(const std::string&)> before;

 private:
  EngineOptions options_;
  Scale scale_;
  std::unique_ptr<Engine> engine_;
  std::map<std::string, std::size_t> known_;  ///< places in rows_
  std::vector<nlohmann::json> rows_;
};

/// Throws unsupported where the device counts no fragments in passes that write the stencil alone.
void need_stencil_fragments(Laboratory& lab);

/// Mean over pixels that face the light of the first light's visibility.
double mean_visibility(const RenderResult& drawn);

}  // namespace penumbra::experiments::claims
