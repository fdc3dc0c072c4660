#include "server/cli/study_client.h"

#include <chrono>
#include <thread>

#include "renderer/error.h"
#include "study/enrolment.h"

namespace penumbra::server::cli {
namespace {

using nlohmann::json;

constexpr int reply_patience_s = 120;
constexpr auto poll = std::chrono::milliseconds(200);

/// Scheme, host and port of an address.
std::string origin_of(const std::string& url) {
  const auto scheme = url.find("://");
  if (scheme == std::string::npos) throw bad_value("--url", "must be like http://127.0.0.1:8080");
  return url.substr(0, url.find('/', scheme + 3));
}

std::string token_in(const std::string& url, const std::string& otherwise) {
  const std::string key = "token=";
  const auto at = url.find(key);
  if (at == std::string::npos) return otherwise;
  return url.substr(at + key.size(), url.find('&', at) - at - key.size());
}

}  // namespace

StudyClient::StudyClient(const std::string& url, const std::string& token)
    : client(origin_of(url)) {
  client.set_keep_alive(true);
  client.set_read_timeout(reply_patience_s);
  const auto used = token_in(url, token);
  if (!used.empty()) client.set_bearer_token_auth(used);
}

json StudyClient::call(const std::string& method, const std::string& path, const json& body) {
  httplib::Request request;
  request.method = method;
  request.path = path;
  if (method != "GET") {
    request.body = body.dump();
    request.set_header("Content-Type", "application/json");
  }
  const auto result = client.send(request);
  if (!result) throw Error("storage", "no server answers at this address", "--url");
  const auto reply = json::parse(result->body, nullptr, false);
  if (reply.is_discarded()) throw unreadable("what answers there is not Penumbra", "--url");
  if (result->status >= 400) {
    const auto& error = reply.at("error");
    throw Error(error.at("code"), error.at("message"), error.at("field"));
  }
  return reply;
}

json StudyClient::open(const study::Study& study) {
  const auto at = "/api/v1/studies/" + study.id;
  auto body = call("POST", "/api/v1/studies", study.document);
  if (body.at("status") == "draft") body = call("POST", at + "/publish");
  if (body.at("status") == "closed") throw Error("conflict", "the study is closed", "STUDY");
  const auto version = at + "?version=" + body.at("version").dump();
  while (body.at("status") == "publishing") {
    std::this_thread::sleep_for(poll);
    body = call("GET", version);
  }
  if (body.at("status") != "open")
    throw Error("conflict", "the study could not be published: " + body.at("progress").dump(),
                "STUDY");
  return body;
}

void StudyClient::take_part(const study::Study& study, const json& body,
                            const study::SimulatedPerson& person,
                            const study::Preferences& preferences) {
  const auto entry = call("POST", "/api/v1/studies/" + study.id + "/participants");
  // Participants are blind; a researcher is told the place, which with the seed is the plan.
  const auto plan = study::plan_enrolment(study, body.at("seed").get<std::uint64_t>(),
                                          entry.at("place").get<std::size_t>());
  const auto at = "/api/v1/participants/" + entry.at("participant").get<std::string>();
  if (study.brightness.minimum_patches > 0)
    call("PUT", at + "/screen", {{"patches_seen", study::dark_patches}});
  for (std::size_t page = 0; page < plan.pages.size(); ++page)
    call("PUT", at + "/pages/" + std::to_string(page),
         study::simulate_answer(study, person, plan, page, preferences));
  call("POST", at + "/complete");
}

}  // namespace penumbra::server::cli
