// Not compiled together with other files: the program of a test has another of these functions,
// whose list is longer by one field (tests/one_more_field).
#include "requests/fields.h"

namespace penumbra::requests {

const std::vector<RequestField>& request_fields() {
  static const std::vector<RequestField> fields = declared_fields();
  return fields;
}

}  // namespace penumbra::requests
