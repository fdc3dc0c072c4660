#include "requests/fields.h"

#include <algorithm>

namespace penumbra::requests {

const RequestField* find_field(const std::string& name) {
  const auto& fields = request_fields();
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const RequestField& field) { return field.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

std::string flag_of(const RequestField& field) {
  std::string flag = field.flag.empty() ? field.name : field.flag;
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

}  // namespace penumbra::requests
