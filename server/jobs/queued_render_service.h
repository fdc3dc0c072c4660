#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "renderer/error.h"
#include "server/jobs/artefact_store.h"
#include "server/jobs/death_list.h"
#include "server/jobs/job_queue.h"
#include "server/jobs/render_service.h"
#include "server/jobs/task.h"
#include "server/jobs/worker_crew.h"

namespace penumbra::server {

/// RenderService over an in-process queue: a thread per worker process takes jobs in turn.
class QueuedRenderService : public RenderService {
 public:
  explicit QueuedRenderService(const RenderServiceOptions& options);
  ~QueuedRenderService() override;

  void check(const nlohmann::json& request) override;
  RenderRecord submit(const nlohmann::json& request, const Submitter& who) override;
  std::optional<RenderRecord> find(const std::string& id) override;
  std::optional<RenderRecord> wait(const std::string& id, double seconds) override;
  std::optional<RenderRecord> wait_change(const std::string& id, const RenderRecord& seen,
                                          double seconds) override;
  bool release(const std::string& id, const std::set<std::string>& keys) override;
  SharedBytes stored_artefact(const std::string& id, const std::string& name) override;
  std::optional<RenderRecord> submit_artefact(const std::string& id, const std::string& name,
                                              const Submitter& who) override;
  std::string trouble() override { return crew_.trouble(); }
  nlohmann::json statistics() override;
  void drain(double deadline_s) override;

 private:
  using Lock = std::unique_lock<std::mutex>;
  using Crewman = std::unique_ptr<WorkerProcess>;

  std::set<std::string> missing(const std::string& id, const std::set<std::string>& wants,
                                std::uint32_t frames);
  std::optional<RenderRecord> stored(const std::string& id);
  std::shared_ptr<Job> job_of(const std::string& id);
  RenderRecord enqueue(CanonicalRequest request, const std::set<std::string>& wants,
                       const Submitter& who);
  void check_admissible(const CanonicalRequest& request, const std::set<std::string>& wants);
  void join(Job& job, const Submitter& who);
  void end(Job& job);

  void work();
  Crewman hire(Lock& lock);
  void execute(const std::shared_ptr<Job>& job, Crewman& worker);
  void try_again(const std::shared_ptr<Job>& job, const std::string& why);
  void draw(Job& job, const std::set<std::string>& wants, Crewman& worker);
  ReferencePictures reference_for(Job& job, Crewman& worker);
  Message run(Job& job, const Message& task, Crewman& worker, double from, double to);
  void keep(const CanonicalRequest& request, const nlohmann::json& device, const Message& result);
  void finish(const std::shared_ptr<Job>& job, const std::set<std::string>& done,
              const std::string& status, const nlohmann::json& error);
  void end_waiting(const Error& error);
  void remember(const RenderRecord& record);

  RenderServiceOptions options_;
  RequestContext context_;
  ArtefactStore store_;
  WorkerCrew crew_;

  std::mutex mutex_;
  std::condition_variable changed_;  ///< something to do for workers, or for a drain
  JobQueue queue_;
  std::map<std::string, std::shared_ptr<Job>> jobs_;  ///< waiting or running
  std::map<std::string, RenderRecord> over_;          ///< failed and cancelled
  std::deque<std::string> over_order_;
  DeathList deaths_;
  bool draining_ = false;
  bool stopping_ = false;
  std::map<std::string, std::uint64_t> counters_;
  std::vector<std::thread> threads_;
};

}  // namespace penumbra::server
