#include "experiments/stability/child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

namespace penumbra::experiments {
namespace {

void write_all(int to, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = ::write(to, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    // The parent is gone: the child has nothing more to do.
    if (count < 0) _exit(1);
    done += static_cast<std::size_t>(count);
  }
}

std::string death_by(int status) {
  if (WIFSIGNALED(status))
    return std::string("signal ") + std::to_string(WTERMSIG(status)) + ", " +
           strsignal(WTERMSIG(status));
  if (WEXITSTATUS(status) != 0) return "exit status " + std::to_string(WEXITSTATUS(status));
  return {};
}

}  // namespace

Child::Child(const std::function<void(const Tell&)>& work) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "pipe");
  std::fflush(nullptr);
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (pid_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    // It may have died before it could send that signal.
    if (::getppid() != parent) _exit(1);
    ::close(ends[0]);
    int state = 0;
    try {
      work([&](const nlohmann::json& line) {
        write_all(ends[1],
                  line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
      });
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      state = 1;
    }
    // No destructors: a device in disorder may wait in them for ever.
    _exit(state);
  }
  ::close(ends[1]);
  pipe_ = ends[0];
}

Child::Child(Child&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      unread_(std::move(other.unread_)),
      death_(std::move(other.death_)) {}

Child::~Child() {
  if (pid_ > 0) {
    kill();
    ::waitpid(pid_, nullptr, 0);
  }
  if (pipe_ >= 0) ::close(pipe_);
}

bool Child::read(const std::function<void(const nlohmann::json&)>& hear) {
  char bytes[65536];
  ssize_t count = 0;
  do {
    count = ::read(pipe_, bytes, sizeof(bytes));
  } while (count < 0 && errno == EINTR);
  if (count > 0) {
    unread_.append(bytes, static_cast<std::size_t>(count));
    std::size_t end = 0;
    while ((end = unread_.find('\n')) != std::string::npos) {
      const auto line = nlohmann::json::parse(unread_.substr(0, end));
      unread_.erase(0, end + 1);
      hear(line);
    }
    return true;
  }
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = -1;
  death_ = death_by(status);
  return false;
}

void Child::kill() {
  if (pid_ > 0) ::kill(pid_, SIGKILL);
}

}  // namespace penumbra::experiments
