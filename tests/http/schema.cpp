#include "tests/http/schema.h"

#include <gtest/gtest.h>

#include <map>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "server/http/documents.h"

namespace penumbra::server::http {
namespace {

const valijson::Schema& schema_of(const std::string& name) {
  static std::map<std::string, valijson::Schema> schemas;
  if (const auto found = schemas.find(name); found != schemas.end()) return found->second;
  // References lead from the document's root: so does the schema that is parsed.
  nlohmann::json root = {{"components", api_document().at("components")}};
  root["allOf"] = nlohmann::json::array({{{"$ref", "#/components/schemas/" + name}}});
  valijson::SchemaParser parser;
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(root), schemas[name]);
  return schemas[name];
}

}  // namespace

void expect_schema(const nlohmann::json& value, const std::string& name) {
  valijson::Validator validator;
  valijson::ValidationResults results;
  const valijson::adapters::NlohmannJsonAdapter adapter(value);
  if (validator.validate(schema_of(name), adapter, &results)) return;
  valijson::ValidationResults::Error error;
  std::string reasons;
  while (results.popError(error)) {
    for (const auto& part : error.context) reasons += part;
    reasons += ": " + error.description + "\n";
  }
  ADD_FAILURE() << "not a " << name << ":\n" << reasons << value.dump(1).substr(0, 2000);
}

}  // namespace penumbra::server::http
