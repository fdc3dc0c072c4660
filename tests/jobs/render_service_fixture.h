#pragma once

#include <gmock/gmock.h>
#include <signal.h>
#include <stdlib.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "renderer/error.h"
#include "server/jobs/render_service.h"
#include "server/jobs/task.h"
#include "tests/jobs/temporary_folder.h"
#include "tests/stand_in_worker/behaviour.h"

namespace penumbra::server {

using nlohmann::json;
using std::chrono::steady_clock;

constexpr double patience_s = 60.0;  // a loaded machine may take its time

/// A service over stand-in workers in a folder of its own.
class RenderServiceTest : public testing::Test {
 protected:
  RenderServiceTest() {
    options.data = folder.path() / "data";
    options.worker_command = {PENUMBRA_STAND_IN_WORKER};
    ::setenv("STAND_IN_LOG", log_path().c_str(), 1);
    for (const char* name : {"STAND_IN_REFUSES_TO_START", "STAND_IN_PADDING", "STAND_IN_LIMITS"})
      ::unsetenv(name);
  }

  std::filesystem::path log_path() const { return folder.path() / "log"; }

  /// Tasks that began, or the lines that begin with `what`.
  std::vector<std::string> log(const std::string& what = "begin") const {
    std::vector<std::string> lines;
    std::ifstream file(log_path());
    for (std::string line; std::getline(file, line);)
      if (line.starts_with(what)) lines.push_back(line);
    return lines;
  }

  void start() { service = make_render_service(options); }

  static json request(int width, Behaviour behaviour = Behaviour::behaves, int takes_ms = 1) {
    return {{"scene", "half-plane"},
            {"technique", "none"},
            {"width", width},
            {"seed", static_cast<int>(behaviour)},
            {"light_samples", takes_ms}};
  }
  static json measured(int width) {
    json body = request(width);
    body["measure"] = true;
    return body;
  }

  RenderRecord ended(const json& body) {
    return *service->wait(service->submit(body).id, patience_s);
  }

  /// Code of the Error that a request is refused with.
  std::string refusal_of(const json& body) {
    try {
      service->submit(body);
      return "";
    } catch (const Error& error) {
      return error.code;
    }
  }

  /// The worker that was started last.
  pid_t process_of_worker() const { return std::stoi(log("start").back().substr(6)); }

  TemporaryFolder folder;
  RenderServiceOptions options;
  std::unique_ptr<RenderService> service;
};

}  // namespace penumbra::server
