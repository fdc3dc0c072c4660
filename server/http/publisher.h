#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "server/jobs/render_service.h"
#include "server/storage/studies.h"

namespace penumbra::server::http {

/// Renders every picture of a study, freezes them under their content, and opens the study. Runs on
/// a thread per study; a publication that a stop interrupts goes on at the next start, where the
/// cache has what was rendered before.
class Publisher {
 public:
  Publisher(storage::Studies& studies_, RenderService& renders_, std::filesystem::path pictures_)
      : studies(studies_), renders(renders_), pictures(std::move(pictures_)) {}
  ~Publisher() { stop(); }

  /// draft -> publishing, and on. Throws bad_value where the document is wrong, conflict where it
  /// is no draft.
  void publish(const storage::StudyRecord& draft);

  /// Goes on with what an earlier process left unfinished.
  void resume();

  /// Waits for the threads; they leave after the picture at hand.
  void stop();

  /// File of a frozen picture.
  std::filesystem::path file_of(const std::string& digest) const {
    return pictures / (digest + ".png");
  }

 private:
  void start(const storage::StudyRecord& record);
  void run(const storage::StudyRecord& record);
  void render_one(const storage::StudyRecord& record, const nlohmann::json& request);
  RenderRecord submit(const storage::StudyRecord& record, const nlohmann::json& request);

  storage::Studies& studies;
  RenderService& renders;
  std::filesystem::path pictures;
  std::atomic<bool> stopping{false};
  std::mutex mutex;
  std::map<std::string, std::thread> threads;  ///< by study; a finished one is joined at the next
};

}  // namespace penumbra::server::http
