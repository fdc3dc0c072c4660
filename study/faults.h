#pragma once

#include <utility>
#include <vector>

#include "renderer/error.h"

namespace penumbra::study {

/// All that is wrong with a study, so that it is mended in one go; as an Error it is the first
/// fault.
class StudyFaults : public Error {
 public:
  explicit StudyFaults(std::vector<Error> all_) : Error(all_.front()), all(std::move(all_)) {}

  std::vector<Error> all;
};

/// Gathers faults of parts that are read one by one.
class FaultList {
 public:
  void add(Error fault) {
    for (const Error& known : list)
      if (known.field == fault.field) return;  // one reason for a place is enough
    list.push_back(std::move(fault));
  }

  template <typename Step>
  void attempt(const Step& step) {
    try {
      step();
    } catch (const Error& fault) {
      add(fault);
    }
  }

  const std::vector<Error>& all() const { return list; }

  void throw_if_any() const {
    if (!list.empty()) throw StudyFaults(list);
  }

 private:
  std::vector<Error> list;
};

}  // namespace penumbra::study
