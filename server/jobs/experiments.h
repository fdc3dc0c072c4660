#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace penumbra::server {

struct ExperimentOptions {
  std::filesystem::path folder;       ///< a folder for each experiment
  std::filesystem::path data;         ///< of imported scenes
  std::string device;                 ///< as RendererOptions::device
  std::vector<std::string> program;   ///< that measures; empty: this one
  double deadline_s = 24.0 * 3600.0;  ///< of one experiment; what it measured is kept
};

/// How far an experiment is.
struct ExperimentState {
  std::string id;
  std::string kind;
  std::string created_at;
  std::string status;       ///< queued, running, done, failed, stopped
  nlohmann::json request;   ///< as it was asked for
  nlohmann::json progress;  ///< {"done","total","measured","left_s","what"}, or null
  nlohmann::json error;     ///< {"code","message","field"}, or null

  bool over() const { return status != "queued" && status != "running"; }
};

/// Every kind of experiment, for forms: [{"kind", "title", "keys": [{"name", "form",
/// "required"}]}]; form is text, number or flag.
nlohmann::json experiment_kinds();

/// The arguments of `penumbra` for a request {"kind", ...}: its kind, then options as on the
/// command line; lists may be arrays. Throws bad_value naming the field. Scenes are names, never
/// paths: what reaches the server must not read its files. A study's results are in `folder`.
std::vector<std::string> experiment_arguments(const nlohmann::json& request,
                                              const std::filesystem::path& folder = {});

/// The study of this server whose results a request needs. Throws as `experiment_arguments`.
std::optional<std::string> study_of_experiment(const nlohmann::json& request);

/// Runs experiments one after the other, since each wants the device for itself, in a process of
/// the program that ends with this one. What was queued or running when the server ended goes on
/// with the next: results are kept run by run.
class Experiments {
 public:
  explicit Experiments(ExperimentOptions options);
  ~Experiments() { stop(); }

  /// `results`: results.json of the study that the request names; empty where it names none.
  /// Throws bad_value; busy where many wait.
  ExperimentState start(const nlohmann::json& request, const std::string& results,
                        const std::string& id, const std::string& now);
  std::optional<ExperimentState> find(const std::string& id);
  /// The newest first.
  std::vector<ExperimentState> list();
  /// Blocks until something changed since `seen`, or `seconds` have passed.
  std::optional<ExperimentState> wait_change(const std::string& id, const ExperimentState& seen,
                                             double seconds);
  /// Ends it where it is not over. False where there is none.
  bool cancel(const std::string& id);
  /// A file of its report: results.csv, report.html or figures/NAME.svg; nothing where there is
  /// none.
  std::optional<std::string> file(const std::string& id, const std::string& name);
  void stop();

 private:
  void load();
  void work();
  void run(const std::string& id);
  void end(const std::string& id, const std::string& status, const nlohmann::json& error);
  bool is_cancelled(const std::string& id);

  ExperimentOptions options_;
  std::atomic<bool> stopping_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, ExperimentState> all_;
  std::map<std::string, bool> cancelled_;
  std::deque<std::string> waiting_;
  std::thread thread_;
};

}  // namespace penumbra::server
