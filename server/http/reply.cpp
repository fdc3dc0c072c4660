#include "server/http/reply.h"

#include <httplib.h>
#include <spdlog/spdlog.h>

#include <map>

namespace penumbra::server::http {
namespace {

std::string text_of(const nlohmann::json& body) {
  return body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
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
      {"device", 500},      {"internal", 500},     {"busy", 503},      {"storage", 503},
      {"draining", 503},    {"worker", 503},       {"deadline", 504},
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

void send_error(httplib::Response& response, const Error& error) {
  set_error_headers(response, error);
  response.set_content(text_of(error_body(error)), "application/json");
}

void send_error_and_close(httplib::Response& response, const Error& error) {
  set_error_headers(response, error);
  response.set_header("Connection", "close");
  // The library closes after a body whose provider gave up; the last chunk was sent by then.
  response.set_chunked_content_provider(
      "application/json",
      [text = text_of(error_body(error))](std::size_t, httplib::DataSink& sink) {
        sink.write(text.data(), text.size());
        sink.done();
        return false;
      });
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
