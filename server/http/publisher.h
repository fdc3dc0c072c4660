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

  /// Waits for the threads; they leave after the picture at hand.
  void stop();

 private:
  struct Publication {
    std::thread thread;
    std::atomic<bool> over{false};
  };

  void start(const storage::StudyRecord& record);
  void insist(const std::string& doing, const std::function<void()>& step);
  void run(const storage::StudyRecord& record);
  void render_one(const storage::StudyRecord& record, const nlohmann::json& request);
  RenderRecord submit(const storage::StudyRecord& record, const nlohmann::json& request);

  storage::Studies& studies;
  RenderService& renders;
  FrozenPictures& pictures;
  std::atomic<bool> stopping{false};
  std::mutex mutex;
  std::map<std::string, std::unique_ptr<Publication>> publications;  ///< by study
};

}  // namespace penumbra::server::http
