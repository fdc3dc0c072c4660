#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "server/http/frozen_pictures.h"
#include "server/jobs/render_service.h"
#include "server/storage/studies.h"

namespace penumbra::server::http {

/// Renders every picture of a study, freezes them under their content, and opens the study. Runs on
/// a thread per study; a publication that a stop interrupts goes on at the next start, where the
/// cache has what was rendered before. A full disk, a locked database or a full queue is waited
/// out.
class Publisher {
 public:
  Publisher(storage::Studies& studies_, RenderService& renders_, FrozenPictures& pictures_)
      : studies(studies_), renders(renders_), pictures(pictures_) {}
  ~Publisher() { stop(); }

  /// draft -> publishing, and on. Throws bad_value where the document is wrong, conflict where it
  /// is no draft.
  void publish(const storage::StudyRecord& draft);

  /// Goes on with what an earlier process left unfinished.
  void resume();

  /// Goes on with one study that is being published, where its thread is gone.
  void resume(const storage::StudyRecord& publishing);

  /// Times the pictures of a published version and measures their errors, beside everything else:
  /// results then hold them against what people saw. What was measured before is left as it is.
  void measure(const storage::StudyRecord& published);

  /// Whether `measure` is at work on the version.
  bool is_measuring(const storage::StudyRecord& published);

  /// Waits for the threads; they leave after the picture at hand.
  void stop();

 private:
  struct Publication {
    std::thread thread;
    std::atomic<bool> over{false};
  };

  enum class Earlier { keep, await };

  /// Runs `work` on a thread of its own under `name`. Where an earlier one of that name is at work
  /// still, it is kept instead, or awaited because it is known to be at its end.
  void start(const std::string& name, Earlier earlier, const std::function<void()>& work);
  void insist(const std::string& doing, const std::function<void()>& step);
  void run(const storage::StudyRecord& record);
  void run_measurement(const storage::StudyRecord& record);
  void freeze(const storage::StudyRecord& record, const nlohmann::json& request,
              const std::string& source, const std::string& png, const nlohmann::json& measures);
  void freeze_own(const storage::StudyRecord& record, const nlohmann::json& request);
  void render_one(const storage::StudyRecord& record, const nlohmann::json& request);
  /// Asks until a render could be taken in.
  RenderRecord submit(const nlohmann::json& request, const Submitter& who);
  /// Asks and waits until the render is over, again where it ended for want of a worker. Throws its
  /// error.
  RenderRecord finished(const nlohmann::json& request, const Submitter& who);

  storage::Studies& studies;
  RenderService& renders;
  FrozenPictures& pictures;
  std::atomic<bool> stopping{false};
  std::mutex mutex;
  std::map<std::string, std::unique_ptr<Publication>> publications;  ///< by name
};

}  // namespace penumbra::server::http
