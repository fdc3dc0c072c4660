// A worker without a device. The request's seed says how it behaves; its light_samples, how many
// milliseconds a picture takes. Every task is a line in the file named by STAND_IN_LOG, every start
// the line "start" and its process. STAND_IN_LIMITS is what it says of its device's memory,
// STAND_IN_PADDING how many bytes its files are longer.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>

#include "server/jobs/drawing_version.h"
#include "server/jobs/message.h"
#include "server/jobs/task.h"
#include "tests/stand_in_worker/behaviour.h"

namespace {

using namespace penumbra::server;
using nlohmann::json;

std::string log_path() {
  const char* path = std::getenv("STAND_IN_LOG");
  return path ? path : "/dev/null";
}

void log_line(const std::string& line) {
  std::ofstream(log_path(), std::ios::app) << line << std::endl;
}

std::string padding() {
  const char* bytes = std::getenv("STAND_IN_PADDING");
  return std::string(bytes ? std::strtoull(bytes, nullptr, 10) : 0, '.');
}

json limits() {
  const char* text = std::getenv("STAND_IN_LIMITS");
  return text ? json::parse(text) : json::object();
}

bool first_time(const std::string& id) {
  const std::string mark = log_path() + "." + id;
  if (std::filesystem::exists(mark)) return false;
  std::ofstream(mark) << "seen";
  return true;
}

Message draw(const json& task) {
  Message reply;
  reply.body["done"] = {{"cost", nullptr}, {"quality", nullptr}, {"notes", json::array()}};
  json& done = reply.body["done"];
  for (const std::string name : task.at("wants")) {
    if (name == want::cost) {
      const int frames = task.at("frames").get<int>() > 0 ? task.at("frames").get<int>() : 9;
      done["cost"] = {{"frame_ms", {{"median", 1.0}, {"p95", 2.0}, {"frames", frames}}}};
    } else if (name == want::quality) {
      done["quality"] = {{"rms_y", 3.0}};
    } else if (name == want::noise) {
      done["noise_rms_y"] = 0.25;
    } else {
      reply.blobs[name] = name + " of " + task.at("id").get<std::string>() + padding();
    }
  }
  return reply;
}

}  // namespace

int main() {
  log_line("start " + std::to_string(::getpid()));
  if (std::getenv("STAND_IN_REFUSES_TO_START")) return 3;
  write_message(STDOUT_FILENO,
                {{{"hello",
                   {{"renderer", drawing_version()},
                    {"limits", limits()},
                    {"device", {{"name", "stand-in"}, {"driver", "none"}, {"type", "cpu"}}}}}},
                 {}});
  MessageReader reader(STDIN_FILENO);
  Message message;
  while (reader.read(message, std::chrono::steady_clock::time_point::max()) == Exchange::message) {
    const json task = message.body.at("task");
    const json& request = task.at("request");
    const std::string id = task.at("id");
    log_line("begin " + id + " " + task.at("wants").dump() +
             (message.body.contains("reference") ? " with reference" : ""));
    switch (static_cast<Behaviour>(request.at("seed").get<int>())) {
      case Behaviour::crashes:
        std::abort();
      case Behaviour::crashes_once:
        if (first_time(id)) std::abort();
        break;
      case Behaviour::hangs:
        while (true) ::pause();
      case Behaviour::refuses:
        write_message(
            STDOUT_FILENO,
            {{{"error",
               {{"code", "unsupported"}, {"message", "no such light"}, {"field", "lights"}}},
              {"fatal", false}},
             {}});
        continue;
      case Behaviour::loses_device_once:
        if (first_time(id)) {
          write_message(STDOUT_FILENO,
                        {{{"error", {{"code", "device"}, {"message", "lost"}, {"field", ""}}},
                          {"fatal", true}},
                         {}});
          ::_exit(1);
        }
        break;
      case Behaviour::talks_nonsense:
        std::cout << "WARNING: lavapipe is not a conformant driver\n" << std::flush;
        ::pause();
        break;
      default:
        break;
    }
    write_message(STDOUT_FILENO, {{{"progress", 0.5}}, {}});
    std::this_thread::sleep_for(std::chrono::milliseconds(request.at("light_samples").get<int>()));
    write_message(STDOUT_FILENO, draw(task));
    log_line("end " + id);
  }
  return 0;
}
