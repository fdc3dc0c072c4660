#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace penumbra {

/// A failure that a user can act on. `code` is stable and machine-readable, `field` names the input
/// at fault (empty where there is none). Front ends map codes to exit states and HTTP states:
///   bad_value (400, exit 2)   not_found (404, exit 2)     unsupported (422, exit 1)
///   unreadable (422, exit 1)  device (503, exit 1)        deadline (504, exit 1)
class Error : public std::runtime_error {
 public:
  Error(std::string code_, const std::string& message, std::string field_ = {})
      : std::runtime_error(message), code(std::move(code_)), field(std::move(field_)) {}

  std::string code;
  std::string field;
};

inline Error bad_value(std::string field, const std::string& message) {
  return {"bad_value", message, std::move(field)};
}
inline Error not_found(std::string field, const std::string& message) {
  return {"not_found", message, std::move(field)};
}
inline Error unsupported(const std::string& message, std::string field = {}) {
  return {"unsupported", message, std::move(field)};
}
inline Error unreadable(const std::string& message, std::string field = {}) {
  return {"unreadable", message, std::move(field)};
}
inline Error device_error(const std::string& message) {
  return {"device", message};
}

}  // namespace penumbra
