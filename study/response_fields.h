#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/responses.h"

namespace penumbra::study {

/// A column of responses.csv and how a row writes and reads it.
struct Field {
  Column column;
  bool required = false;
  std::function<std::string(const ResponseRow&)> write;
  std::function<void(ResponseRow&, const std::string&)> read;
};

/// In the order of the file.
const std::vector<Field>& response_fields();

}  // namespace penumbra::study
