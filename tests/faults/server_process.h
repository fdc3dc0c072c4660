#pragma once

#include <httplib.h>
#include <sys/resource.h>
#include <sys/types.h>

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace penumbra::faults {

/// How a server is started.
struct ServerOptions {
  std::filesystem::path data;
  std::vector<std::string> arguments;  ///< further ones of `penumbra serve`
  std::map<std::string, std::string> environment;
  int port = 0;              ///< 0: any free one
  bool count_memory = true;  ///< towards the suite's bound
};

/// `penumbra serve` as a process of its own, watched from outside. Ends with the object.
class ServerProcess {
 public:
  /// Returns once it serves, or has ended by itself (`running` tells).
  explicit ServerProcess(ServerOptions options);
  ~ServerProcess();
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  bool running() const;
  /// SIGKILL, and waits for the end.
  void kill();
  /// SIGTERM, and waits; its exit state, or 128 + signal; -1 where it did not end in time.
  int terminate(double seconds = 60);
  void send_signal(int signal) const;
  /// Starts it anew on the same port.
  void start();
  void restart() {
    kill();
    start();
  }

  httplib::Client client() const;
  httplib::Client researcher() const;
  httplib::Client operations() const;
  int port() const { return port_; }
  int ops_port() const { return ops_port_; }
  const std::string& token() const { return token_; }
  pid_t pid() const { return pid_; }
  const std::filesystem::path& data() const { return options_.data; }

  /// State of /readyz: 200, 503, or 0 where nothing was heard.
  int ready() const;
  /// One number of /metrics, by its whole name with labels; 0 where it is not there.
  double metric(const std::string& name) const;
  /// Waits until the metric has at least this value; false after `seconds`.
  bool wait_metric(const std::string& name, double least, double seconds = 30) const;
  /// Resident memory now, bytes.
  std::size_t resident() const;
  /// The most since the last `forget_peak`.
  std::size_t peak() const { return peak_; }
  void forget_peak() { peak_ = resident(); }
  std::size_t descriptors() const;
  /// Its children: the processes that draw.
  std::vector<pid_t> workers() const;
  /// Waits until there is one, and returns it; -1 after `seconds`.
  pid_t worker(double seconds = 30) const;
  /// Soft limit of the running process.
  void limit(__rlimit_resource resource, std::size_t value) const;
  /// What it wrote to standard error, all starts together.
  std::string log() const;

 private:
  void spawn();
  void watch();

  ServerOptions options_;
  pid_t pid_ = -1;
  int port_ = 0;
  int ops_port_ = 0;
  std::string token_;
  std::filesystem::path output_;  ///< files of standard output and error
  std::filesystem::path errors_;
  std::atomic<std::size_t> peak_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread watcher_;
};

/// Calls `condition` every `pause_ms` until it holds; false after `seconds`.
template <class Condition>
bool eventually(Condition condition, double seconds = 20, int pause_ms = 10) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms));
  }
  return true;
}

/// Seconds since it was made.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Seconds that `action` takes.
template <class Action>
double seconds_of(Action action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Runs the program with arguments; its exit state, and what it printed to both streams.
struct ProgramResult {
  int status = -1;
  std::string output;
};
ProgramResult run_program(const std::vector<std::string>& arguments);

}  // namespace penumbra::faults
