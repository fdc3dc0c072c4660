// Study files to begin with.
#include "server/http/documents.h"
#include "server/http/reply.h"
#include "server/http/service.h"

namespace penumbra::server::http {
namespace {

using nlohmann::json;

/// A template's document as its file has it.
json document_of(const EmbeddedFile& file) {
  return json::parse(file.text);
}

void list_templates(Call& call) {
  auto list = json::array();
  for (const auto& file : embedded_templates()) {
    const auto study = study::parse_study(document_of(file));
    list.push_back({{"id", study.id},
                    {"title", study.title.at(study.languages.front())},
                    {"about", study.document.value("about", "")},
                    {"links", {{"self", "/api/v1/templates/" + study.id}}}});
  }
  send_json(call.response, 200, {{"templates", list}});
}

void get_template(Call& call) {
  for (const auto& file : embedded_templates()) {
    const auto document = document_of(file);
    if (document.at("id") == call.path.at("id")) return send_json(call.response, 200, document);
  }
  throw nothing_here();
}

}  // namespace

void add_template_routes(std::vector<Route>& table) {
  table.push_back({"GET", "/api/v1/templates", Access::researcher, list_templates});
  table.push_back({"GET", "/api/v1/templates/{id}", Access::researcher, get_template});
}

}  // namespace penumbra::server::http
