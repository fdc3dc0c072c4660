#include "techniques/parameter_schema.h"

#include <gtest/gtest.h>

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "renderer/error.h"

namespace penumbra::techniques {
namespace {

using nlohmann::json;

std::vector<Parameter> declared() {
  return {
      {.name = "map_size",
       .type = ParameterType::integer,
       .default_value = std::int64_t{512},
       .minimum = 1,
       .maximum = 16384,
       .scale = ParameterScale::logarithmic,
       .unit = "texels",
       .meaning = "width and height of the map"},
      {.name = "bias",
       .default_value = 0.5,
       .minimum = -1.0,
       .maximum = 1.0,
       .unit = "m",
       .meaning = "distance towards the light"},
      {.name = "clamp",
       .type = ParameterType::boolean,
       .default_value = true,
       .meaning = "bound the volumes"},
      {.name = "blur",
       .type = ParameterType::choice,
       .default_value = std::string("box"),
       .choices = {"box", "gauss"},
       .meaning = "shape of the kernel"},
  };
}

/// Whether another library finds `values` to follow the schema.
bool follows_schema(const json& values) {
  const json document = parameter_schema(declared());
  valijson::Schema schema;
  valijson::SchemaParser parser;
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(document), schema);
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  return validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(values), nullptr);
}

bool is_accepted(const json& values) {
  try {
    complete_parameters(declared(), values_from_json(values));
    return true;
  } catch (const Error&) {
    return false;
  }
}

TEST(ParameterSchema, AdmitsWhatIsAcceptedAndNothingElse) {
  const std::vector<std::pair<json, bool>> cases{
      {json::object(), true},
      {{{"map_size", 1}, {"bias", -1.0}, {"clamp", false}, {"blur", "gauss"}}, true},
      {{{"map_size", 16384}}, true},
      {{{"map_size", 0}}, false},
      {{{"map_size", 16385}}, false},
      {{{"map_size", 1.5}}, false},
      {{{"map_size", true}}, false},
      {{{"bias", 1}}, true},
      {{{"bias", 1.001}}, false},
      {{{"bias", json::array()}}, false},
      {{{"clamp", 1}}, false},
      {{{"blur", "median"}}, false},
      {{{"colour", 1}}, false},
  };
  for (const auto& [values, good] : cases) {
    EXPECT_EQ(follows_schema(values), good) << values;
    EXPECT_EQ(is_accepted(values), good) << values;
  }
}

TEST(ParameterSchema, CarriesWhatAFormNeeds) {
  const json properties = parameter_schema(declared()).at("properties");
  EXPECT_EQ(properties.at("map_size"), (json{{"type", "integer"},
                                             {"default", 512},
                                             {"minimum", 1},
                                             {"maximum", 16384},
                                             {"description", "width and height of the map"},
                                             {"x-unit", "texels"},
                                             {"x-scale", "logarithmic"},
                                             {"x-order", 0}}));
  EXPECT_EQ(properties.at("clamp"), (json{{"type", "boolean"},
                                          {"default", true},
                                          {"description", "bound the volumes"},
                                          {"x-order", 2}}));
  EXPECT_EQ(properties.at("blur").at("enum"), (json{"box", "gauss"}));
  EXPECT_EQ(properties.at("bias").at("x-scale"), "linear");
  EXPECT_FALSE(properties.at("bias").contains("x-only-with"));
}

TEST(ParameterSchema, TellsTheChoicesThatAParameterNeeds) {
  std::vector<Parameter> list = declared();
  list[1].only_with = Choices{"blur", {"gauss", "box"}};
  EXPECT_EQ(parameter_schema(list).at("properties").at("bias").at("x-only-with"),
            (json{{"blur", {"gauss", "box"}}}));
}

TEST(ParameterSchema, KeepsWholeLimitsWhole) {
  const json map_size = parameter_schema(declared()).at("properties").at("map_size");
  EXPECT_EQ(map_size.at("maximum").dump(), "16384");
}

TEST(ParameterValuesInJson, SurviveTheRoundTrip) {
  const ParameterValues values{{"a", true},
                               {"b", std::int64_t{-7}},
                               {"c", 1.0 / 3.0},
                               {"d", 4.0},
                               {"e", std::string("text")}};
  const std::string text = values_to_json(values).dump();
  EXPECT_EQ(text, R"({"a":true,"b":-7,"c":0.3333333333333333,"d":4.0,"e":"text"})");
  EXPECT_EQ(values_from_json(json::parse(text)), values);
}

TEST(ParameterValuesInJson, NameTheKeyThatHoldsNoValue) {
  try {
    values_from_json({{"taps", nullptr}});
    FAIL() << "null was taken for a value";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "bad_value");
    EXPECT_EQ(error.field, "taps");
  }
}

}  // namespace
}  // namespace penumbra::techniques
