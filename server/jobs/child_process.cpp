#include "server/jobs/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <utility>

extern char** environ;

namespace penumbra::server {
namespace {

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

pid_t spawn(std::vector<std::string> arguments, const std::filesystem::path& driver_cache,
            int input, int output) {
  std::vector<std::string> environment = environment_with(driver_cache);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);

  // Its own group, so that a terminal's Ctrl-C reaches the server alone, which ends children
  // itself.
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
    throw std::system_error(failure, std::generic_category(), "starting " + arguments.front());
  return process;
}

std::string end_in_words(int status) {
  if (WIFSIGNALED(status))
    return "ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
           ::strsignal(WTERMSIG(status)) + ")";
  return "ended with status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> arguments,
                           const std::filesystem::path& driver_cache) {
  Pipe to_child;
  Pipe from_child;
  process_ = spawn(std::move(arguments), driver_cache, to_child.read_end, from_child.write_end);
  // The child's own ends close with their pipes here, or its death would not be seen.
  input_ = std::exchange(to_child.write_end, -1);
  output_ = std::exchange(from_child.read_end, -1);
  // A child may stop reading: writing must then end at a deadline. Its own end still blocks.
  ::fcntl(input_, F_SETFL, O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
  kill();
}

void ChildProcess::kill() {
  if (process_ > 0) {
    ::kill(-process_, SIGKILL);
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = -1;
  }
  if (input_ >= 0) ::close(std::exchange(input_, -1));
  if (output_ >= 0) ::close(std::exchange(output_, -1));
}

std::optional<std::string> ChildProcess::ended(double patience_s) {
  using std::chrono::steady_clock;
  if (process_ <= 0) return {};
  const auto deadline = steady_clock::now() + std::chrono::duration<double>(patience_s);
  int status = 0;
  pid_t found = 0;
  while ((found = ::waitpid(process_, &status, WNOHANG)) == 0 && steady_clock::now() < deadline)
    ::usleep(5000);
  if (found != process_) return {};
  process_ = -1;
  kill();
  return end_in_words(status);
}

}  // namespace penumbra::server
