#include "server/jobs/worker_process.h"

#include <system_error>

#include "renderer/error.h"
#include "server/jobs/deadline.h"
#include "server/jobs/drawing_version.h"
#include "server/jobs/memory_budget.h"

namespace penumbra::server {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

std::unique_ptr<ChildProcess> start(const WorkerCommand& command) {
  try {
    return std::make_unique<ChildProcess>(command.arguments, command.driver_cache);
  } catch (const std::system_error& error) {
    throw WorkerLost("a worker could not be started: " + std::string(error.what()));
  }
}

}  // namespace

WorkerProcess::WorkerProcess(const WorkerCommand& command, const std::function<bool()>& cancelled)
    : child_(start(command)), reader_(child_->output()) {
  try {
    const Message hello = read(after(command.start_s), cancelled);
    if (hello.body.contains("error")) raise(hello.body);
    if (!hello.body.contains("hello")) lost("did not say hello");
    if (hello.body["hello"].value("renderer", "") != drawing_version())
      lost("is of another version than the server");
    device_ = hello.body["hello"].value("device", json(nullptr));
    limits_ = limits_from_json(hello.body["hello"].value("limits", json::object()));
  } catch (...) {
    child_->kill();
    throw;
  }
}

std::optional<std::string> WorkerProcess::died_idle() {
  const auto how = child_->ended(0.0);
  if (!how) return {};
  return "the worker " + *how;
}

void WorkerProcess::lost(const std::string& during) {
  // It may be ending right now; how it ends is worth a moment.
  const auto how = child_->ended(0.5);
  child_->kill();
  throw WorkerLost("the worker " + during + (how ? ": " + *how : ""));
}

void WorkerProcess::raise(const json& body) {
  const json error = body.at("error");
  if (body.value("fatal", false)) child_->kill();
  throw Error(error.value("code", "internal"), error.value("message", ""),
              error.value("field", ""));
}

void WorkerProcess::require_message(Exchange outcome) {
  switch (outcome) {
    case Exchange::message:
      return;
    case Exchange::stopped:
      child_->kill();
      throw WorkCancelled();
    case Exchange::deadline:
      child_->kill();
      throw Error("deadline", "the renderer did not answer in time and was stopped");
    case Exchange::garbled:
      lost("does not keep to the protocol");
    case Exchange::closed:
      break;
  }
  lost("is gone");
}

Message WorkerProcess::read(steady_clock::time_point deadline,
                            const std::function<bool()>& cancelled) {
  Message message;
  require_message(reader_.read(message, deadline, cancelled));
  return message;
}

Message WorkerProcess::run(const Message& task, double deadline_s,
                           const std::function<void(double)>& progress,
                           const std::function<bool()>& cancelled) {
  if (!alive()) throw WorkerLost("the worker is not running");
  const auto deadline = after(deadline_s);
  require_message(write_message(child_->input(), task, deadline, cancelled));
  while (true) {
    Message message = read(deadline, cancelled);
    if (message.body.contains("error")) raise(message.body);
    if (message.body.contains("done")) return message;
    if (!message.body.contains("progress")) lost("does not keep to the protocol");
    if (progress) progress(message.body["progress"]);
  }
}

}  // namespace penumbra::server
