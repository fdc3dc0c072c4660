#include "server/http/documents.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "renderer/render.h"
#include "server/http/routes.h"
#include "tests/http/running_server.h"

namespace penumbra::server::http {
namespace {

std::set<std::string> served() {
  std::set<std::string> calls;
  for (const auto& route : routes()) calls.insert(route.method + " " + route.path);
  return calls;
}

std::set<std::string> described() {
  std::set<std::string> calls;
  for (const auto& [path, methods] : api_document().at("paths").items())
    for (const std::string method : {"get", "put", "post", "delete"})
      if (methods.contains(method)) {
        std::string upper = method;
        std::transform(upper.begin(), upper.end(), upper.begin(),
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        calls.insert(upper + " " + path);
      }
  return calls;
}

TEST(TheDocument, DescribesEveryRouteAndNoOther) {
  EXPECT_EQ(described(), served());
}

TEST(TheDocument, SaysWhoMayCallWhat) {
  // OpenAPI: an empty requirement beside another makes it optional.
  const std::map<Access, json> marks{
      {Access::anyone, nullptr},
      {Access::laboratory, json::parse(R"([{}, {"researcher": []}])")},
      {Access::researcher, json::parse(R"([{"researcher": []}])")}};
  for (const auto& route : routes()) {
    std::string method = route.method;
    std::transform(method.begin(), method.end(), method.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto& operation = api_document().at("paths").at(route.path).at(method);
    EXPECT_EQ(operation.value("security", json()), marks.at(route.access))
        << route.method << " " << route.path;
  }
}

TEST(TheDocument, ResolvesAllItsReferences) {
  const std::function<void(const json&)> visit = [&](const json& value) {
    if (value.is_object() && value.contains("$ref")) {
      const json::json_pointer place(value["$ref"].get<std::string>().substr(1));
      EXPECT_TRUE(api_document().contains(place)) << value["$ref"];
    }
    for (const auto& inner : value)
      if (inner.is_structured()) visit(inner);
  };
  visit(api_document());
}

TEST(TheDocument, GivesTheRangesThatTheRendererHas) {
  const json& keys = api_document().at("/components/schemas/RenderRequest/properties"_json_pointer);
  const RenderRequest defaults;
  for (const char* key : {"width", "height"}) {
    EXPECT_EQ(keys.at(key).at("maximum"), RenderLimits::max_size);
    EXPECT_EQ(keys.at(key).at("default"), defaults.width);
  }
  EXPECT_EQ(keys.at("supersampling").at("enum"), json(RenderLimits::supersampling));
  EXPECT_EQ(keys.at("light_samples").at("maximum"), RenderLimits::max_light_samples);
  EXPECT_EQ(keys.at("light_samples").at("default"), defaults.light_samples);
  EXPECT_EQ(keys.at("error_bound").at("maximum"), RenderLimits::max_error_bound);
  EXPECT_EQ(keys.at("error_bound").at("default"), defaults.error_bound);
  EXPECT_EQ(keys.at("exposure").at("minimum"), -RenderLimits::max_exposure);
  EXPECT_EQ(keys.at("exposure").at("maximum"), RenderLimits::max_exposure);
}

TEST(Yaml, KeepsTheTypesOfItsScalars) {
  const auto value = json_of_yaml(
      "a: 1\nb: '1'\nc: true\nd: null\ne: text\nf: [1.5, x]\ng: &g {k: 1}\nh: {<<: *g, l: 2}\n");
  EXPECT_EQ(value, json::parse(R"({"a":1,"b":"1","c":true,"d":null,"e":"text","f":[1.5,"x"],
                                   "g":{"k":1},"h":{"k":1,"l":2}})"));
}

using ServedDocument = RunningServer;

TEST_F(ServedDocument, IsOpenApi) {
  const auto result = client->Get("/openapi.json");
  ASSERT_TRUE(result);
  EXPECT_EQ(json::parse(result->body).at("openapi"), "3.1.0");
}

TEST_F(ServedDocument, AnswersUnknownAddressesAllAlike) {
  const auto a = client->Get("/nothing");
  const auto b = client->Get("/api/v1/renders/unknown");
  const auto c = client->Get("/api/v1/participants/unknown");
  const auto d = client->Get("/s/unknown");
  const auto e = client->Post("/api/v1/studies/unknown/participants", "{}", "application/json");
  for (const auto* result : {&a, &b, &c, &d, &e}) {
    EXPECT_EQ(error_of(*result, 404), "not_found");
    EXPECT_EQ((*result)->body, a->body);
  }
}

TEST_F(ServedDocument, NamesTheMethodsOfAnAddress) {
  const auto result = client->Put("/api/v1/scenes", "{}", "application/json");
  EXPECT_EQ(error_of(result, 405), "not_allowed");
  EXPECT_EQ(result->get_header_value("Allow"), "GET");
}

}  // namespace
}  // namespace penumbra::server::http
