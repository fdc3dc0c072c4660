#include "server/jobs/worker.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <iostream>
#include <new>
#include <system_error>

#include "renderer/error.h"
#include "server/jobs/canonical_request.h"
#include "server/jobs/drawing_version.h"
#include "server/jobs/memory_budget.h"
#include "server/jobs/scene_reader.h"
#include "server/jobs/task.h"

namespace penumbra::server {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

constexpr auto between_progress = std::chrono::milliseconds(50);

/// One part in so many of a worker's memory is for scenes that it keeps.
constexpr std::uint64_t kept_scene_share = 4;

/// Keeps the protocol's channel apart from what drivers and layers print to standard output.
int claim_output() {
  const int channel = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 10);
  if (channel < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
    throw std::system_error(errno, std::generic_category(), "setting up the worker's channel");
  return channel;
}

std::uint64_t memory_of(const WorkerOptions& options) {
  return options.memory_limit > 0 ? options.memory_limit : worker_memory(1);
}

json error_body(const Error& error, bool fatal) {
  return {{"error", {{"code", error.code}, {"message", error.what()}, {"field", error.field}}},
          {"fatal", fatal}};
}

Task task_from(Message& message, const WorkerOptions& options) {
  const json& body = message.body.at("task");
  json request = body.at("request");
  const std::string renderer = request.at("renderer");
  const std::string scene_hash = request.at("scene_hash");
  for (const char* derived : {"renderer", "scene_hash", "device"}) request.erase(derived);
  if (body.at("frames") != 0) request["frames"] = body.at("frames");

  Task task;
  // Scenes that come again, however large, are not read again.
  task.request = read_request(
      request, {options.data, options.device, false, memory_of(options) / kept_scene_share});
  if (task.request.request.at("renderer") != renderer)
    throw unsupported("this picture was drawn by another version of the renderer: ask for it anew");
  if (task.request.request.at("scene_hash") != scene_hash)
    throw unsupported("the scene has changed since this picture was asked for: ask for it anew",
                      "scene");
  task.checkpoints = {checkpoint_folder(options.data), options.checkpoint_s};
  task.wants = body.at("wants").get<std::set<std::string>>();
  if (const auto reference = message.body.find("reference"); reference != message.body.end()) {
    task.reference.id = reference->at("id");
    task.reference.noise_rms_y = reference->at("noise_rms_y");
    task.reference.image = std::move(message.blobs[want::image]);
    task.reference.visibility = std::move(message.blobs[want::visibility]);
  }
  return task;
}

Message answer(Renderer& renderer, Message& message, const WorkerOptions& options, int channel) {
  const Task task = task_from(message, options);
  auto last = steady_clock::now() - between_progress;
  const auto progress = [&](double value) {
    const auto now = steady_clock::now();
    if (now - last < between_progress) return;
    last = now;
    write_message(channel, {{{"progress", value}}, {}});
  };
  TaskResult result = run_task(renderer, task, progress);
  Message reply;
  reply.body["done"] = {
      {"cost", result.cost}, {"quality", result.quality}, {"notes", result.notes}};
  // Absent and null differ: not asked for, and not to be known.
  if (task.wants.contains(want::noise)) reply.body["done"]["noise_rms_y"] = result.noise_rms_y;
  reply.blobs = std::move(result.artefacts);
  return reply;
}

/// Ends at once: destroying a device may wait for ever.
[[noreturn]] void end(int status) {
  std::cerr.flush();
  ::_exit(status);
}

[[noreturn]] void serve_tasks(const WorkerOptions& options, int channel) {
  std::optional<Renderer> renderer;
  const std::uint64_t allowance =
      options.memory_limit > 0 ? options.memory_limit : worker_memory(1);
  try {
    renderer.emplace(RendererOptions{options.device, options.validation});
    limit_memory(allowance);
  } catch (const Error& error) {
    write_message(channel, {error_body(error, true), {}});
    end(1);
  } catch (const std::exception& error) {
    write_message(channel, {error_body(device_error(error.what()), true), {}});
    end(1);
  }
  write_message(channel, {{{"hello",
                            {{"renderer", drawing_version()},
                             {"device", device_to_json(renderer->device())},
                             {"limits", limits_to_json(limits_within(*renderer, allowance))}}}},
                          {}});

  MessageReader reader(STDIN_FILENO);
  Message message;
  while (true) {
    // What a picture took goes back to the system: the next may be long in coming.
    message = {};
    ::malloc_trim(0);
    if (reader.read(message, steady_clock::time_point::max()) != Exchange::message) break;
    try {
      const Message reply = answer(*renderer, message, options, channel);
      write_message(channel, reply);
    } catch (const Error& error) {
      // A lost device does not come back within the process.
      const bool fatal = error.code == "device";
      write_message(channel, {error_body(error, fatal), {}});
      if (fatal) end(1);
    } catch (const std::bad_alloc&) {
      const Error error = unsupported("this picture needs more memory than a worker may have");
      write_message(channel, {error_body(error, true), {}});
      end(1);
    } catch (const std::system_error&) {
      end(1);  // the server is gone
    } catch (const std::exception& error) {
      write_message(channel, {error_body(Error("internal", error.what()), true), {}});
      end(1);
    }
  }
  end(0);
}

}  // namespace

int run_worker(const WorkerOptions& options) {
  if (!options.read_scene.empty()) return run_scene_reader(options.read_scene, memory_of(options));
  if (!options.read_picture.empty())
    return run_picture_reader(options.read_picture, memory_of(options));
  // A worker never outlives who asked for it.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::signal(SIGPIPE, SIG_IGN);
  const int channel = claim_output();
  try {
    serve_tasks(options, channel);
  } catch (const std::exception& error) {
    std::cerr << "worker: " << error.what() << '\n';
    end(1);
  }
}

}  // namespace penumbra::server
