#include "server/http/documents.h"

#include <yaml-cpp/yaml.h>

#include "renderer/error.h"
#include "requests/schema.h"
#include "server/http/reply.h"
#include "server/http/routes.h"

namespace penumbra::server::http {
namespace {

nlohmann::json scalar_of(const YAML::Node& node) {
  const auto& text = node.Scalar();
  if (node.Tag() == "!") return text;  // quoted
  if (text == "null" || text == "~" || text.empty()) return nullptr;
  if (text == "true") return true;
  if (text == "false") return false;
  const auto number = nlohmann::json::parse(text, nullptr, false);
  return number.is_number() ? number : nlohmann::json(text);
}

nlohmann::json value_of(const YAML::Node& node) {
  if (node.IsSequence()) {
    auto list = nlohmann::json::array();
    for (const auto& item : node) list.push_back(value_of(item));
    return list;
  }
  if (node.IsMap()) {
    auto object = nlohmann::json::object();
    for (const auto& entry : node) {
      const auto key = entry.first.Scalar();
      if (key == "<<")
        object.update(value_of(entry.second));
      else
        object[key] = value_of(entry.second);
    }
    return object;
  }
  return node.IsScalar() ? scalar_of(node) : nlohmann::json(nullptr);
}

void get_api(Call& call) {
  send_json(call.response, 200, api_document());
}

}  // namespace

nlohmann::json json_of_yaml(const std::string& text) {
  try {
    return value_of(YAML::Load(text));
  } catch (const YAML::Exception& error) {
    throw bad_value("yaml", error.what());
  }
}

const nlohmann::json& api_document() {
  static const auto document = [] {
    auto api = json_of_yaml(std::string(embedded_api().front().text));
    api.at("components").at("schemas").at("RenderRequest") = requests::request_schema();
    for (const char* path : {"/api/v1/image", "/api/v1/plan"})
      api.at("paths").at(path).at("get")["parameters"] = requests::query_parameters();
    return api;
  }();
  return document;
}

void add_document_routes(std::vector<Route>& table) {
  table.push_back({"GET", "/openapi.json", Access::laboratory, get_api});
}

}  // namespace penumbra::server::http
