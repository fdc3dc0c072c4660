#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "experiments/engine/results.h"
#include "experiments/engine/timing.h"
#include "experiments/engine/view.h"
#include "renderer/render.h"
#include "techniques/registry.h"

namespace penumbra::experiments {

/// What a picture is judged against.
enum class Truth {
  none,  ///< nothing: only costs are measured
  area,  ///< what the lights do with their extents
  hard   ///< exact hard shadows of the lights' centres
};

/// One thing to measure.
struct Run {
  std::string scene;           ///< as scenes::load takes it
  std::string technique;       ///< id of a technique or preset
  ParameterValues parameters;  ///< over the preset's
  std::string name;            ///< in tables and figures; empty: the technique's id
  std::uint32_t width = 600;   ///< pixels
  std::uint32_t height = 600;
  std::uint32_t light_samples = 1024;  ///< of the truth, and of techniques that take many
  Truth truth = Truth::none;
  bool picture = false;  ///< keep the picture as a file
  View view;
  /// Lights that are drawn without their extents; the truth keeps them.
  std::set<std::string> hard_lights;
  bool idle_casters = false;  ///< draw also casters that the plan would leave out
};

struct EngineOptions {
  std::filesystem::path folder;  ///< holds results.jsonl and pictures/; made if it is not there
  std::filesystem::path data;    ///< of imported scenes; may be empty
  std::string device;            ///< as RendererOptions
  TimingBudget timing;
  /// Called around what is timed; what it returns is held meanwhile. May be empty.
  std::function<std::shared_ptr<void>()> alone;
  /// Errors are reckoned in threads beside the drawing; by default not on processors, whose times
  /// would tell.
  std::optional<bool> judged_beside;
};

/// Measures runs in process and keeps what it measured: a run that is known is not measured again,
/// also after a kill. A scene is loaded and uploaded once while runs of it follow each other, and
/// so are its truths and the time of `none` of a view, which is taken in the same sitting.
class Engine {
 public:
  explicit Engine(EngineOptions options);
  /// Waits for what was begun and keeps it.
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// The run's result: what was asked for (scene, technique, ...), `status` done or failed,
  /// `error`, frame_ms, p95_ms, spread, frames, settled, none_ms, over_none, create_ms,
  /// memory_bytes, counters, `passes`, `notes`, and against a truth rms_y, flip, visibility_rms,
  /// false_shadow, missing_shadow. A technique that refuses the scene is a result too. Throws Error
  /// for scenes and techniques that there are not, and where the device fails.
  nlohmann::json measure(const Run& run);

  /// The same in two parts: draws and times the run now, and judges its picture in a thread.
  /// Throws as `measure` does.
  void begin(const Run& run);
  /// Times runs of one view, for which `begin` then only draws the picture, where errors are
  /// reckoned beside: a GPU that waits for errors between two times lowers its clocks.
  void time_first(const std::vector<Run>& runs);
  /// The result of the run that was begun first, once it is judged.
  nlohmann::json next();
  /// Runs that were begun and not asked for.
  std::size_t begun() const { return begun_.size(); }
  /// How many may be judged beside what is drawn.
  std::size_t most_begun() const;

  /// Runs that were measured, not known.
  std::size_t measured() const { return measured_; }
  const DeviceInfo& device() const { return renderer_.device(); }
  /// For pictures that are looked at and not kept.
  Renderer& renderer() { return renderer_; }
  /// What the run draws, with complete parameters. Throws as `measure` does.
  RenderRequest request_of(const Run& run);
  /// The scene of that name, kept while it is asked for again.
  std::shared_ptr<const Scene> scene(const std::string& name);

 private:
  struct Judge {
    Image8 picture;
    ImageF visibility;
  };
  struct Begun {
    nlohmann::json row;  ///< what was asked for
    std::string key;
    std::future<nlohmann::json> fresh;  ///< not valid where the result is known
  };
  struct Baseline {
    double ms = 0.0;
    bool settled = true;
    std::chrono::steady_clock::time_point when;
  };
  struct Timed {
    Cost cost;
    std::vector<std::string> notes;
    Baseline before;  ///< of `none`; empty for itself
  };

  bool is_known(const std::string& key) const;
  Timed time(const Run& run, const RenderRequest& request, const Cost* drawn = nullptr);
  nlohmann::json key_of(const Run& run, const techniques::Resolved& technique);
  std::future<nlohmann::json> measure_now(const Run& run, const techniques::Resolved& technique,
                                          const std::string& key);
  RenderRequest request_of(const Run& run, const techniques::Resolved& technique);
  RenderRequest truth_of(const Run& run);
  std::shared_ptr<const Judge> judge_of(const Run& run);
  const Baseline& baseline_of(const Run& run);

  EngineOptions options_;
  Results results_;
  Renderer renderer_;
  FrameTimer timer_;
  std::size_t measured_ = 0;
  std::string scene_name_;
  std::shared_ptr<const Scene> scene_;
  std::string scene_hash_;
  /// The scene at hand as runs change it, by what they change: drawn ones stay uploaded.
  std::map<std::string, std::shared_ptr<const Scene>> changed_;
  std::shared_ptr<const Scene> scene_for(const Run& run);

  /// Of the scene at hand, by view.
  std::map<std::string, std::shared_ptr<const Judge>> judges_;
  std::map<std::string, Baseline> baselines_;
  std::map<std::string, Timed> timed_;  ///< by key: not drawn for their errors yet
  std::deque<Begun> begun_;
};

/// How far a list of runs is.
struct Progress {
  std::size_t done = 0;
  std::size_t total = 0;
  std::size_t measured = 0;      ///< of `done`: not known before
  std::optional<double> left_s;  ///< once something was measured
  std::string what;              ///< is measured next
};

/// Measures all runs, scene by scene, view by view, `none` first. Returns results in that order.
/// `progress` is called before every run and at the end; throwing from it ends the list.
std::vector<nlohmann::json> run_all(Engine& engine, std::vector<Run> runs,
                                    const std::function<void(const Progress&)>& progress);

/// The first technique of a family: `none`, `truth` (area lights), `traced` (hard shadows).
const TechniqueDescription& technique_of_family(const std::string& family);

/// Whether it is the technique of family `none`, which times are compared with.
bool is_baseline(const Run& run);

/// Names what runs share of a scene whose truth and time of `none` are one.
std::string view_of(const Run& run);

/// A technique with parameters as people write it, ID[:NAME=VALUE]..., for every run of it.
/// Throws bad_value and not_found as techniques::resolve does.
struct NamedTechnique {
  std::string name;  ///< as written
  std::string id;
  ParameterValues parameters;
};
NamedTechnique read_technique(const std::string& text);

/// Parts of a list that commas separate, without blanks around them and without empty ones.
std::vector<std::string> parts_of(const std::string& list, char separator = ',');

}  // namespace penumbra::experiments
