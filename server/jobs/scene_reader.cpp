#include "server/jobs/scene_reader.h"

#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <new>

#include "renderer/error.h"
#include "scenes/library.h"
#include "server/jobs/child_process.h"
#include "server/jobs/memory_budget.h"
#include "server/jobs/message.h"

namespace penumbra::server {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

}  // namespace

SceneReader::SceneReader(SceneReaderOptions options) : options_(std::move(options)) {
  if (options_.command.empty()) options_.command = {"/proc/self/exe", "worker"};
  if (options_.memory_limit == 0) options_.memory_limit = worker_memory(most_at_once);
}

json SceneReader::read(const std::filesystem::path& file, const std::function<bool()>& stopping) {
  const auto deadline =
      steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(
                                std::chrono::duration<double>(options_.deadline_s));
  if (!places_.try_acquire_until(deadline)) throw Error("busy", "other scenes are being read");
  struct Place {
    decltype(places_)& places;
    ~Place() { places.release(); }
  } const place{places_};

  ++read_;
  std::vector<std::string> arguments = options_.command;
  arguments.insert(arguments.end(), {"--memory-limit", std::to_string(options_.memory_limit),
                                     "--read-scene", file.string()});
  ChildProcess child(std::move(arguments), {});
  Message message;
  switch (MessageReader(child.output()).read(message, deadline, stopping)) {
    case Exchange::message:
      break;
    case Exchange::stopped:
      throw Error("draining", "the server is stopping");
    case Exchange::deadline:
      ++deadlines_;
      throw Error("deadline", "the scene was not read in time");
    default: {
      ++died_;
      const auto how = child.ended(0.5);
      throw unreadable("the reader " + how.value_or("failed") + " at this file", "body");
    }
  }
  if (const auto error = message.body.find("error"); error != message.body.end()) {
    ++refused_;
    throw Error(error->value("code", "internal"), error->value("message", ""),
                error->value("field", ""));
  }
  return message.body.at("scene");
}

json SceneReader::statistics() const {
  return {{"read", read_.load()},
          {"refused", refused_.load()},
          {"died", died_.load()},
          {"deadlines", deadlines_.load()}};
}

int run_scene_reader(const std::filesystem::path& file, std::uint64_t memory_limit) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // never outlives who waits for it
  json body;
  try {
    limit_memory(memory_limit);
    const auto scene = scenes::load(file.string());
    body["scene"] = {{"title", scene->title}, {"notes", scene->notes}};
  } catch (const Error& error) {
    body["error"] = {{"code", error.code}, {"message", error.what()}, {"field", error.field}};
  } catch (const std::bad_alloc&) {
    body["error"] = {{"code", "unsupported"},
                     {"message", "this scene needs more memory than reading it may take"},
                     {"field", "body"}};
  }
  write_message(STDOUT_FILENO, {body, {}});
  return 0;
}

}  // namespace penumbra::server
