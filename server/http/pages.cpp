// The pages and their files, built in or from a folder while they are being written.
#include <algorithm>
#include <map>
#include <optional>

#include "server/files/digest.h"
#include "server/http/documents.h"
#include "server/http/guard.h"
#include "server/http/reply.h"
#include "server/http/service.h"

namespace penumbra::server::http {
namespace {

std::string media_type(const std::string& name) {
  static const std::map<std::string, std::string> types{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".svg", "image/svg+xml"},
  };
  const auto found = types.find(std::filesystem::path(name).extension().string());
  return found == types.end() ? "application/octet-stream" : found->second;
}

bool plain_name(const std::string& name) {
  return !name.empty() && name.front() != '.' && std::none_of(name.begin(), name.end(), [](char c) {
    return c == '/' || c == '\\' || c == '\0';
  });
}

std::optional<std::string> page_file(const Service& service, const std::string& folder,
                                     const std::string& name) {
  const bool known = folder == "participant" || folder == "researcher" || folder == "shared";
  if (!known || !plain_name(name)) return std::nullopt;
  if (!service.options.web.empty()) {
    const auto file = service.options.web / folder / name;
    if (!std::filesystem::is_regular_file(file)) return std::nullopt;
    return storage::read_file(file);
  }
  const std::string path = "web/" + folder + "/" + name;
  for (const auto& file : embedded_pages())
    if (file.path == path) return std::string(file.text);
  return std::nullopt;
}

void send_page(Call& call, const std::string& folder, const std::string& name) {
  const auto text = page_file(call.service, folder, name);
  if (!text) throw nothing_here();
  // Kept, but asked for again: the files of a page are of one version always.
  call.response.set_header("Cache-Control", "no-cache");
  if (client_has(call.request, call.response, sha256(*text).substr(0, 32))) return;
  call.response.status = 200;
  call.response.set_content(*text, media_type(name));
}

void get_asset(Call& call) {
  send_page(call, call.path.at("folder"), call.path.at("file"));
}

void get_participant_page(Call& call) {
  const auto& study = call.path.at("study");
  // A draft has a page for researchers, who look at it before they publish.
  const bool shown =
      call.service.studies.latest_published(study) ||
      (call.request.has_param("preview") && is_researcher(call.service, call.request) &&
       call.service.studies.current(study));
  if (!shown) throw nothing_here();
  send_page(call, "participant", "index.html");
}

/// A browser, not a program.
bool reads_pages(const httplib::Request& request) {
  return request.get_header_value("Accept").find("text/html") != std::string::npos;
}

/// The page to sign in on, with what was wrong with the token that was given.
void ask_for_token(Call& call, const std::optional<Error>& wrong) {
  auto text = page_file(call.service, "researcher", "sign-in.html");
  if (!text) throw nothing_here();
  if (wrong) {
    const std::string place = "<!-- problem -->";
    text->replace(text->find(place), place.size(), wrong->what());
  }
  call.response.status = 401;
  call.response.set_content(*text, media_type("sign-in.html"));
}

/// The token moves from the address, which stays in histories, to a cookie that scripts cannot
/// read.
void open_session(Call& call) {
  httplib::Request as_header = call.request;
  as_header.headers.erase("Authorization");
  as_header.set_header("Authorization", "Bearer " + call.request.get_param_value("token"));
  if (!is_researcher(call.service, as_header)) {
    const Error wrong("unauthorized", "this is not the researcher's token", "token");
    if (!reads_pages(call.request)) throw wrong;
    return ask_for_token(call, wrong);
  }
  std::string cookie = session_cookie;
  cookie.append("=").append(session_of(call.service.token));
  cookie.append("; Path=/; HttpOnly; SameSite=Strict");
  if (call.request.get_header_value("X-Forwarded-Proto") == "https") cookie.append("; Secure");
  call.response.set_header("Set-Cookie", cookie);
  call.response.status = 303;
  call.response.set_header("Location", "/lab");
}

void get_lab(Call& call) {
  if (call.request.has_param("token")) return open_session(call);
  if (!is_researcher(call.service, call.request)) {
    if (reads_pages(call.request)) return ask_for_token(call, std::nullopt);
    throw Error("unauthorized", "open the address with the token that the server printed", "token");
  }
  send_page(call, "researcher", "index.html");
}

void get_root(Call& call) {
  call.response.status = 303;
  call.response.set_header("Location", "/lab");
}

}  // namespace

void add_page_routes(std::vector<Route>& table) {
  table.push_back({"GET", "/", Access::laboratory, get_root});
  table.push_back({"GET", "/lab", Access::anyone, get_lab});
  table.push_back({"GET", "/s/{study}", Access::anyone, get_participant_page});
  table.push_back({"GET", "/assets/{folder}/{file}", Access::anyone, get_asset});
}

}  // namespace penumbra::server::http
