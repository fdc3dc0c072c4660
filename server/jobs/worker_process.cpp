#include "server/jobs/worker_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "renderer/error.h"
#include "server/jobs/drawing_version.h"
#include "server/jobs/memory_budget.h"

extern char** environ;

namespace penumbra::server {
namespace {

using nlohmann::json;
using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::steady_clock;

steady_clock::time_point after(double seconds) {
  return steady_clock::now() + duration_cast<steady_clock::duration>(duration<double>(seconds));
}

/// Two ends of a pipe that no other child inherits.
struct Pipe {
  int read_end = -1;
  int write_end = -1;

  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
      throw std::system_error(errno, std::generic_category(), "making a pipe");
    read_end = ends[0];
    write_end = ends[1];
  }
  ~Pipe() {
    if (read_end >= 0) ::close(read_end);
    if (write_end >= 0) ::close(write_end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
};

std::vector<std::string> environment_with(const std::filesystem::path& driver_cache) {
  std::vector<std::string> list;
  const std::string name = "MESA_SHADER_CACHE_DIR=";
  for (char** entry = environ; *entry; ++entry)
    if (driver_cache.empty() || std::strncmp(*entry, name.c_str(), name.size()) != 0)
      list.emplace_back(*entry);
  if (!driver_cache.empty()) list.push_back(name + driver_cache.string());
  return list;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> list;
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

pid_t spawn(const WorkerCommand& command, int input, int output) {
  std::vector<std::string> arguments = command.arguments;
  std::vector<std::string> environment = environment_with(command.driver_cache);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);

  // Its own group, so that a terminal's Ctrl-C reaches the server alone, which ends workers itself.
  sigset_t none;
  sigemptyset(&none);
  sigset_t usual;
  sigemptyset(&usual);
  for (const int signal : {SIGPIPE, SIGTERM, SIGINT, SIGXFSZ}) sigaddset(&usual, signal);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  pid_t process = -1;
  const int failure =
      ::posix_spawnp(&process, arguments.front().c_str(), &actions, &attributes,
                     pointers_to(arguments).data(), pointers_to(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (failure != 0)
    throw WorkerLost("a worker could not be started: " + std::string(std::strerror(failure)));
  return process;
}

std::string end_in_words(int status) {
  if (WIFSIGNALED(status))
    return "ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
           ::strsignal(WTERMSIG(status)) + ")";
  return "ended with status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

WorkerProcess::WorkerProcess(const WorkerCommand& command, const std::function<bool()>& cancelled) {
  Pipe to_worker;
  Pipe from_worker;
  process_ = spawn(command, to_worker.read_end, from_worker.write_end);
  input_ = std::exchange(to_worker.write_end, -1);
  // Its reader may stop reading: writing must then end at the deadline. The worker's end, another
  // description, still blocks.
  ::fcntl(input_, F_SETFL, O_NONBLOCK);
  output_ = std::exchange(from_worker.read_end, -1);
  reader_ = std::make_unique<MessageReader>(output_);
  // The worker's own ends must be closed here, or its death would not be seen.
  ::close(std::exchange(to_worker.read_end, -1));
  ::close(std::exchange(from_worker.write_end, -1));

  try {
    const Message hello = read(after(command.start_s), cancelled);
    if (hello.body.contains("error")) raise(hello.body);
    if (!hello.body.contains("hello")) lost("did not say hello");
    if (hello.body["hello"].value("renderer", "") != drawing_version())
      lost("is of another version than the server");
    device_ = hello.body["hello"].value("device", json(nullptr));
    limits_ = limits_from_json(hello.body["hello"].value("limits", json::object()));
  } catch (...) {
    kill();
    throw;
  }
}

WorkerProcess::~WorkerProcess() {
  kill();
}

void WorkerProcess::kill() {
  if (process_ > 0) {
    ::kill(-process_, SIGKILL);
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = -1;
  }
  if (input_ >= 0) ::close(std::exchange(input_, -1));
  if (output_ >= 0) ::close(std::exchange(output_, -1));
}

std::optional<std::string> WorkerProcess::died_idle() {
  int status = 0;
  if (process_ <= 0 || ::waitpid(process_, &status, WNOHANG) != process_) return {};
  process_ = -1;
  kill();
  return "the worker " + end_in_words(status);
}

void WorkerProcess::lost(const std::string& during) {
  std::string how = during;
  if (process_ > 0) {
    // It may be ending right now; how it ends is worth a moment.
    int status = 0;
    const auto deadline = after(0.5);
    pid_t ended = 0;
    while ((ended = ::waitpid(process_, &status, WNOHANG)) == 0 && steady_clock::now() < deadline)
      ::usleep(5000);
    if (ended == process_) {
      how += ": " + end_in_words(status);
      process_ = -1;
    }
  }
  kill();
  throw WorkerLost("the worker " + how);
}

void WorkerProcess::raise(const json& body) {
  const json error = body.at("error");
  if (body.value("fatal", false)) kill();
  throw Error(error.value("code", "internal"), error.value("message", ""),
              error.value("field", ""));
}

void WorkerProcess::require_message(Exchange outcome) {
  switch (outcome) {
    case Exchange::message:
      return;
    case Exchange::stopped:
      kill();
      throw WorkCancelled();
    case Exchange::deadline:
      kill();
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
  require_message(reader_->read(message, deadline, cancelled));
  return message;
}

Message WorkerProcess::run(const Message& task, double deadline_s,
                           const std::function<void(double)>& progress,
                           const std::function<bool()>& cancelled) {
  if (!alive()) throw WorkerLost("the worker is not running");
  const auto deadline = after(deadline_s);
  require_message(write_message(input_, task, deadline, cancelled));
  while (true) {
    Message message = read(deadline, cancelled);
    if (message.body.contains("error")) raise(message.body);
    if (message.body.contains("done")) return message;
    if (!message.body.contains("progress")) lost("does not keep to the protocol");
    if (progress) progress(message.body["progress"]);
  }
}

}  // namespace penumbra::server
