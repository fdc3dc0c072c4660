#pragma once

#include <chrono>
#include <string>

namespace penumbra::server::cli {

/// Tells on standard error how far something is: a bar on a terminal, otherwise a line now and
/// then.
class Progress {
 public:
  explicit Progress(std::string title);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `value` 0..1; `what` is being done now.
  void show(double value, const std::string& what = {});

  /// A line that stays, above the bar.
  void note(const std::string& line);

 private:
  std::string title_;
  bool terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace penumbra::server::cli
