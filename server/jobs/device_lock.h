#pragma once

#include <filesystem>

namespace penumbra::server {

/// Programs of this machine that draw on the same device see each other through an advisory lock in
/// the user's runtime folder: those that draw share it, one that times holds it alone. It is a
/// courtesy between measurements, never a condition of drawing: who cannot have it goes on.
class DeviceLock {
 public:
  enum class Mode { draw, measure };

  /// Waits up to `patience_s` for the lock.
  DeviceLock(Mode mode, double patience_s);
  ~DeviceLock();
  DeviceLock(const DeviceLock&) = delete;
  DeviceLock& operator=(const DeviceLock&) = delete;

  bool held() const { return held_; }

  static std::filesystem::path path();

 private:
  int file_ = -1;
  bool held_ = false;
};

}  // namespace penumbra::server
