#include "server/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace penumbra::server::cli {
namespace {

using std::chrono::steady_clock;

constexpr int bar_width = 32;  // characters
constexpr auto bar_interval = std::chrono::milliseconds(100);
constexpr auto line_interval = std::chrono::seconds(5);  // logs stay short

}  // namespace

Progress::Progress(std::string title)
    : title_(std::move(title)),
      terminal_(::isatty(STDERR_FILENO) != 0),
      started_(steady_clock::now()),
      last_(terminal_ ? steady_clock::time_point{} : steady_clock::now()) {}

Progress::~Progress() {
  if (terminal_ && shown_) std::fputs("\r\033[K", stderr);
}

void Progress::show(double value, const std::string& what) {
  const auto now = steady_clock::now();
  if (now - last_ < (terminal_ ? steady_clock::duration(bar_interval) : line_interval)) return;
  last_ = now;
  shown_ = true;
  value = std::clamp(value, 0.0, 1.0);
  const int percent = static_cast<int>(100.0 * value);
  if (!terminal_) {
    std::fprintf(stderr, "%s: %d%% %s\n", title_.c_str(), percent, what.c_str());
    return;
  }
  const auto full = static_cast<std::size_t>(value * bar_width);
  const std::string bar = std::string(full, '#') + std::string(bar_width - full, '.');
  const double elapsed = std::chrono::duration<double>(now - started_).count();
  std::fprintf(stderr, "\r\033[K%s [%s] %3d%% %.0f s %s", title_.c_str(), bar.c_str(), percent,
               elapsed, what.c_str());
  std::fflush(stderr);
}

void Progress::note(const std::string& line) {
  std::fprintf(stderr, "%s%s\n", terminal_ && shown_ ? "\r\033[K" : "", line.c_str());
}

}  // namespace penumbra::server::cli
