#include "tests/faults/server_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <regex>
#include <sstream>

#include "tests/faults/ledger.h"

namespace penumbra::faults {
namespace {

constexpr double longest_start_s = 120;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string first_match(const std::string& text, const std::string& pattern) {
  std::smatch found;
  return std::regex_search(text, found, std::regex(pattern)) ? found[1].str() : "";
}

/// False for a process that is gone, or dead and not yet waited for.
bool alive(pid_t process) {
  const auto stat = text_of("/proc/" + std::to_string(process) + "/stat");
  const auto name_end = stat.rfind(") ");
  return name_end != std::string::npos && stat[name_end + 2] != 'Z' && stat[name_end + 2] != 'X';
}

httplib::Client client_of(int port) {
  httplib::Client client("127.0.0.1", port);
  client.set_keep_alive(true);
  // The library sends head and body apart: the second would wait 40 ms for the first one's ACK.
  client.set_tcp_nodelay(true);
  client.set_connection_timeout(10);
  client.set_read_timeout(120);
  return client;
}

}  // namespace

ServerProcess::ServerProcess(ServerOptions options) : options_(std::move(options)) {
  port_ = options_.port;
  output_ = options_.data.string() + ".output";
  errors_ = options_.data.string() + ".errors";
  start();
}

ServerProcess::~ServerProcess() {
  kill();
}

void ServerProcess::spawn() {
  std::vector<std::string> arguments = {PENUMBRA_PROGRAM, "serve",  "--data",
                                        options_.data,    "--port", std::to_string(port_),
                                        "--ops-port",     "0"};
  arguments.insert(arguments.end(), options_.arguments.begin(), options_.arguments.end());
  std::vector<char*> pointers;
  for (auto& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  std::vector<std::string> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) environment.emplace_back(*entry);
  for (const auto& [name, value] : options_.environment) environment.push_back(name + "=" + value);
  std::vector<char*> variables;
  for (auto& variable : environment) variables.push_back(variable.data());
  variables.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (std::freopen(output_.c_str(), "w", stdout) == nullptr) ::_exit(126);
    if (std::freopen(errors_.c_str(), "a", stderr) == nullptr) ::_exit(126);
    ::execvpe(PENUMBRA_PROGRAM, pointers.data(), variables.data());
    ::_exit(127);
  }
}

void ServerProcess::start() {
  std::error_code ignored;
  std::filesystem::remove(output_, ignored);
  const std::size_t earlier = log().size();
  spawn();
  const bool up = eventually(
      [&] { return text_of(output_).find("/lab?token=") != std::string::npos || !running(); },
      longest_start_s);
  if (!up || !running()) return;
  // The line may still lack its end.
  eventually([&] { return text_of(output_).ends_with('\n'); }, 5);
  const auto printed = text_of(output_);
  port_ = std::stoi("0" + first_match(printed, "Researchers: *https?://[^/]*:([0-9]+)/"));
  token_ = first_match(printed, "/lab\\?token=(\\S+)");
  const std::string ops = "health and metrics on (?:port |\\S*:)([0-9]+)";
  eventually([&] { return !first_match(log().substr(earlier), ops).empty(); }, 5);
  ops_port_ = std::stoi("0" + first_match(log().substr(earlier), ops));
  stopping_ = false;
  watcher_ = std::thread([this] { watch(); });
}

void ServerProcess::watch() {
  while (!stopping_) {
    const std::size_t now = resident();
    if (now > peak_) peak_ = now;
    if (options_.count_memory && now > most_resident()) most_resident() = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

bool ServerProcess::running() const {
  if (pid_ <= 0) return false;
  siginfo_t state{};
  return ::waitid(P_PID, static_cast<id_t>(pid_), &state, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         state.si_pid == 0;
}

void ServerProcess::kill() {
  stopping_ = true;
  if (watcher_.joinable()) watcher_.join();
  if (pid_ <= 0) return;
  const auto orphans = workers();
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
  pid_ = -1;
  // The system ends them too, a moment later: until then they may still write to the folder.
  const auto gone = [](pid_t worker) { return !alive(worker); };
  EXPECT_TRUE(eventually([&] { return std::ranges::all_of(orphans, gone); }, 10));
}

int ServerProcess::terminate(double seconds) {
  send_signal(SIGTERM);
  int status = 0;
  const bool ended = eventually([&] { return ::waitpid(pid_, &status, WNOHANG) == pid_; }, seconds);
  if (!ended) return -1;
  pid_ = -1;
  kill();
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

void ServerProcess::send_signal(int signal) const {
  ::kill(pid_, signal);
}

httplib::Client ServerProcess::client() const {
  return client_of(port_);
}

httplib::Client ServerProcess::researcher() const {
  auto client = client_of(port_);
  client.set_bearer_token_auth(token_);
  return client;
}

httplib::Client ServerProcess::operations() const {
  return client_of(ops_port_);
}

int ServerProcess::ready() const {
  const auto result = operations().Get("/readyz");
  return result ? result->status : 0;
}

double ServerProcess::metric(const std::string& name) const {
  const auto result = operations().Get("/metrics");
  if (!result) return 0.0;
  const auto at = ("\n" + result->body).find("\n" + name + " ");
  if (at == std::string::npos) return 0.0;
  return std::stod(result->body.substr(at + name.size() + 1));
}

bool ServerProcess::wait_metric(const std::string& name, double least, double seconds) const {
  return eventually([&] { return metric(name) >= least; }, seconds);
}

std::size_t ServerProcess::resident() const {
  std::ifstream file("/proc/" + std::to_string(pid_) + "/statm");
  std::size_t whole = 0;
  std::size_t pages = 0;
  file >> whole >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

std::size_t ServerProcess::descriptors() const {
  std::size_t count = 0;
  std::error_code error;
  const auto folder = "/proc/" + std::to_string(pid_) + "/fd";
  for (auto at = std::filesystem::directory_iterator(folder, error);
       at != std::filesystem::directory_iterator(); at.increment(error))
    ++count;
  return count;
}

std::vector<pid_t> ServerProcess::workers() const {
  std::vector<pid_t> found;
  std::error_code error;
  const auto tasks = "/proc/" + std::to_string(pid_) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks, error)) {
    std::ifstream children(task.path() / "children");
    for (pid_t child = 0; children >> child;) found.push_back(child);
  }
  return found;
}

pid_t ServerProcess::worker(double seconds) const {
  wait_metric("penumbra_renders_workers_alive", 1, seconds);
  const auto found = workers();
  return found.empty() ? -1 : found.front();
}

void ServerProcess::limit(__rlimit_resource resource, std::size_t value) const {
  rlimit now{};
  ::prlimit(pid_, resource, nullptr, &now);
  now.rlim_cur = std::min<rlim_t>(value, now.rlim_max);
  ASSERT_EQ(::prlimit(pid_, resource, &now, nullptr), 0);
}

std::string ServerProcess::log() const {
  return text_of(errors_);
}

ProgramResult run_program(const std::vector<std::string>& arguments) {
  std::string command = PENUMBRA_PROGRAM;
  for (const auto& argument : arguments) command += " '" + argument + "'";
  ProgramResult result;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer{};
  while (const auto count = std::fread(buffer.data(), 1, buffer.size(), pipe))
    result.output.append(buffer.data(), count);
  const int status = ::pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

}  // namespace penumbra::faults
