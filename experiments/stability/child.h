#pragma once

#include <sys/types.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace penumbra::experiments {

/// A forked copy of this process that does one piece of work and tells of it in lines of JSON, so
/// that a driver that crashes or never returns ends the copy alone. Fork before the first device is
/// made: drivers' threads do not survive it.
class Child {
 public:
  using Tell = std::function<void(const nlohmann::json&)>;

  /// `work` runs in the child, which ends with it.
  explicit Child(const std::function<void(const Tell&)>& work);
  ~Child();
  Child(Child&& other) noexcept;
  Child& operator=(Child&&) = delete;

  /// Descriptor that becomes readable when something is told, or at the end.
  int descriptor() const { return pipe_; }
  /// Calls `hear` for the lines that are there; false once the child has ended.
  bool read(const std::function<void(const nlohmann::json&)>& hear);
  /// SIGKILL.
  void kill();
  /// Empty where it ended by itself and well, otherwise how it died. After `read` returned false.
  const std::string& death() const { return death_; }

 private:
  pid_t pid_ = -1;
  int pipe_ = -1;
  std::string unread_;
  std::string death_;
};

}  // namespace penumbra::experiments
