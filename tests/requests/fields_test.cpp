#include "requests/fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "renderer/error.h"
#include "requests/reader.h"
#include "requests/schema.h"

namespace penumbra::requests {
namespace {

using nlohmann::json;

/// What the value of a field is read as; a refusal as text.
json read(const RequestField& field, const json& value) {
  try {
    return read_value(field, value);
  } catch (const Error& error) {
    EXPECT_EQ(error.field, field.name);
    return "refused: " + std::string(error.what());
  }
}

bool refused(const RequestField& field, const json& value) {
  const json result = read(field, value);
  return result.is_string() && result.get<std::string>().starts_with("refused: ");
}

/// The words of another library on a request.
bool schema_accepts(const json& request) {
  valijson::Schema schema;
  valijson::SchemaParser parser;
  const json document = request_schema();
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(document), schema);
  valijson::Validator validator;
  return validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(request), nullptr);
}

json plain_with(const std::string& key, const json& value) {
  json request{{"scene", "boxes"}, {"technique", "none"}};
  request[key] = value;
  return request;
}

TEST(RequestFields, say_what_they_are_and_show_a_value) {
  std::set<std::string> names;
  for (const RequestField& field : request_fields()) {
    EXPECT_TRUE(names.insert(field.name).second) << field.name << " is declared twice";
    EXPECT_NE(field.meaning, "") << field.name;
    EXPECT_EQ(read(field, field.example), field.example) << field.name;
    for (const auto& value : {field.default_value, field.in_studies}) {
      if (value.is_null()) continue;
      EXPECT_EQ(read(field, value), value) << field.name;
    }
  }
}

// The schema and the reader are derived from the same declaration by different ways.
TEST(RequestFields, are_accepted_by_reader_and_schema_alike) {
  const std::vector<json> values{true,
                                 "",
                                 "text",
                                 -1,
                                 0,
                                 1,
                                 1.5,
                                 2,
                                 3,
                                 4,
                                 16,
                                 17,
                                 -30.5,
                                 30.5,
                                 255,
                                 256,
                                 16384,
                                 16385,
                                 65536,
                                 65537,
                                 1e300,
                                 json::array(),
                                 json::object(),
                                 json{{"a", json::object()}}};
  for (const RequestField& field : request_fields())
    for (const json& value : values) {
      if (field.required && value == "") continue;
      EXPECT_EQ(schema_accepts(plain_with(field.name, value)), !refused(field, value))
          << field.name << " " << value;
    }
  EXPECT_FALSE(schema_accepts(plain_with("wdith", 600)));
  EXPECT_FALSE(schema_accepts({{"scene", "boxes"}}));
}

TEST(RequestFields, name_what_is_allowed) {
  EXPECT_EQ(read(*find_field("supersampling"), 3),
            "refused: supersampling must be one of 1, 4, 16, not 3");
  EXPECT_EQ(read(*find_field("width"), 0),
            "refused: width must be an integer from 1 to 16384, not 0");
  EXPECT_EQ(read(*find_field("exposure"), "bright"),
            "refused: exposure must be a number from -30.0 to 30.0, not \"bright\"");
}

TEST(RequestFields, are_read_from_the_text_that_their_examples_have) {
  for (const RequestField& field : request_fields()) {
    if (field.kind == FieldKind::parameters || field.kind == FieldKind::changes) continue;
    const std::string text =
        field.example.is_string() ? field.example.get<std::string>() : field.example.dump();
    EXPECT_EQ(request_from_text({{field.name, text}}), (json{{field.name, field.example}}));
  }
  for (const std::string name : {"lights", "cameras"}) {
    const RequestField& field = *find_field(name);
    const std::string change = change_example(field);
    const auto sign = change.find('=');
    EXPECT_EQ(
        request_from_text({{field.entry + "." + change.substr(0, sign), change.substr(sign + 1)}}),
        (json{{name, field.example}}));
  }
}

TEST(RequestFields, are_all_in_a_query_but_the_parameters) {
  std::set<std::string> in_query;
  for (const json& parameter : query_parameters()) in_query.insert(parameter.at("name"));
  for (const RequestField& field : request_fields()) {
    if (field.kind == FieldKind::parameters) continue;
    EXPECT_TRUE(in_query.contains(field.entry.empty() ? field.name : field.entry + ".NAME.key"))
        << field.name;
  }
}

}  // namespace
}  // namespace penumbra::requests
