#include "server/http/reply.h"
#include "scenes/json_text.h"

#include <httplib.h>
#include <spdlog/spdlog.h>

#include <map>

namespace penumbra::server::http {
namespace {

std::string text_of(const nlohmann::json& body) {
  return scenes::json_text(body);
}

void set_error_headers(httplib::Response& response, const Error& error) {
  response.status = status_of(error.code);
  if (response.status == 503 || response.status == 429) response.set_header("Retry-After", "2");
  if (response.status == 401) response.set_header("WWW-Authenticate", "Bearer");
}

}  // namespace

int status_of(const std::string& code) {
  static const std::map<std::string, int> states{
      {"bad_value", 400},   {"unauthorized", 401}, {"forbidden", 403}, {"not_found", 404},
      {"not_allowed", 405}, {"conflict", 409},     {"cancelled", 409}, {"too_large", 413},
      {"unsupported", 422}, {"unreadable", 422},   {"too_many", 429},  {"too_many_headers", 431},
      {"too_long", 414},    {"too_slow", 408},     {"device", 503},    {"internal", 500},
      {"busy", 503},        {"storage", 503},      {"draining", 503},  {"worker", 503},
      {"deadline", 504},
  };
  const auto found = states.find(code);
  return found == states.end() ? 500 : found->second;
}

nlohmann::json error_body(const Error& error) {
  return {{"error", {{"code", error.code}, {"message", error.what()}, {"field", error.field}}}};
}

void send_json(httplib::Response& response, int status, const nlohmann::json& body) {
  response.status = status;
  response.set_content(text_of(body), "application/json");
}

bool client_has(const httplib::Request& request, httplib::Response& response,
                const std::string& tag) {
  const std::string quoted = '"' + tag + '"';
  response.set_header("ETag", quoted);
  const auto known = request.get_header_value("If-None-Match");
  if (known != "*" && known.find(quoted) == std::string::npos) return false;
  response.status = 304;
  return true;
}

void send_error(httplib::Response& response, const Error& error) {
  set_error_headers(response, error);
  response.set_content(text_of(error_body(error)), "application/json");
}

void set_security_headers(httplib::Response& response) {
  response.set_header("X-Content-Type-Options", "nosniff");
  response.set_header("X-Frame-Options", "DENY");
  response.set_header("Referrer-Policy", "no-referrer");
  response.set_header("Cross-Origin-Resource-Policy", "same-origin");
  response.set_header("Cross-Origin-Opener-Policy", "same-origin");
  // For every answer: an error page or a file opened by itself runs nothing either.
  if (!response.has_header("Content-Security-Policy"))
    response.set_header("Content-Security-Policy",
                        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' "
                        "blob:; connect-src 'self'; form-action 'self'; base-uri 'none'; "
                        "frame-ancestors 'none'");
  if (!response.has_header("Cache-Control")) response.set_header("Cache-Control", "no-store");
}

std::string refusal_text(const Error& error, const std::vector<std::string>& methods,
                         bool with_body) {
  httplib::Response response;
  send_error(response, error);
  set_security_headers(response);
  response.set_header("Connection", "close");
  response.set_header("Content-Length", std::to_string(response.body.size()));
  std::string allowed;
  for (const auto& method : methods) allowed += (allowed.empty() ? "" : ", ") + method;
  if (response.status == 405) response.set_header("Allow", allowed);
  std::string text = "HTTP/1.1 " + std::to_string(response.status) + " Refused\r\n";
  for (const auto& [name, value] : response.headers) text += name + ": " + value + "\r\n";
  return text + "\r\n" + (with_body ? response.body : "");
}

Error error_of(std::exception_ptr failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const Error& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return {"busy", "out of memory"};
  } catch (const std::exception& error) {
    spdlog::error("a request failed: {}", error.what());
    return {"internal", "the server failed; its log says why"};
  }
}

Error nothing_here() {
  return not_found("", "there is nothing at this address");
}

}  // namespace penumbra::server::http
