#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::server {

/// A child with pipes to its standard input and output, killed with this object. The thread that
/// made it must outlive it: children of this program ask the kernel to end with that thread.
class ChildProcess {
 public:
  /// `arguments` begin with the program. `driver_cache` is where a driver keeps its compiled
  /// shaders; it may be empty. Throws std::system_error.
  ChildProcess(std::vector<std::string> arguments, const std::filesystem::path& driver_cache);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  int input() const { return input_; }    ///< to the child; does not block
  int output() const { return output_; }  ///< from the child

  bool running() const { return process_ > 0; }
  void kill();

  /// How it ended, in words, if it does so within `patience_s` seconds; it runs no longer then.
  std::optional<std::string> ended(double patience_s);

 private:
  pid_t process_ = -1;
  int input_ = -1;
  int output_ = -1;
};

}  // namespace penumbra::server
