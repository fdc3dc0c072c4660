#pragma once

#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "renderer/image.h"

namespace penumbra {

/// Bytes of values in the order they are given, for the same program on the same kind of machine.
class ArchiveWriter {
 public:
  template <class T>
  void operator()(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <class T>
  void operator()(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    (*this)(std::uint64_t{values.size()});
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  template <class T>
  void operator()(const Image<T>& image) {
    (*this)(image.width);
    (*this)(image.height);
    (*this)(image.channels);
    (*this)(image.pixels);
  }

  std::string bytes;
};

/// Reads what ArchiveWriter wrote. Throws std::runtime_error where there is not as much.
class ArchiveReader {
 public:
  explicit ArchiveReader(const std::string& bytes) : bytes_(bytes) {}

  template <class T>
  void operator()(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    copy(&value, sizeof(T));
  }
  template <class T>
  void operator()(std::vector<T>& values) {
    std::uint64_t count = 0;
    (*this)(count);
    if (count > (bytes_.size() - place_) / sizeof(T)) throw std::runtime_error("archive ends");
    values.resize(count);
    copy(values.data(), count * sizeof(T));
  }
  template <class T>
  void operator()(Image<T>& image) {
    (*this)(image.width);
    (*this)(image.height);
    (*this)(image.channels);
    (*this)(image.pixels);
  }
  bool at_end() const { return place_ == bytes_.size(); }

 private:
  void copy(void* target, std::size_t count) {
    if (count > bytes_.size() - place_) throw std::runtime_error("archive ends");
    if (count > 0) std::memcpy(target, bytes_.data() + place_, count);
    place_ += count;
  }

  const std::string& bytes_;
  std::size_t place_ = 0;
};

}  // namespace penumbra
