// Linked in place of requests/request_fields.cpp.
#include "requests/fields.h"

namespace penumbra::requests {

const std::vector<RequestField>& request_fields() {
  static const std::vector<RequestField> fields = [] {
    std::vector<RequestField> longer = declared_fields();
    longer.push_back({.name = "film_grain",
                      .kind = FieldKind::integer,
                      .meaning = "Grains per pixel",
                      .example = 4,
                      .minimum = 2,
                      .maximum = 8,
                      .default_value = 3,
                      .in_studies = 5,
                      .label = "Film grain"});
    return longer;
  }();
  return fields;
}

}  // namespace penumbra::requests
