#include "server/http/routes.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <optional>
#include <set>

#include "server/http/body.h"
#include "server/http/guard.h"
#include "server/http/reply.h"
#include "server/http/request_head.h"
#include "server/http/service.h"

namespace penumbra::server::http {
namespace {

constexpr std::size_t longest_path = 1024;

std::vector<std::string_view> segments(std::string_view path) {
  std::vector<std::string_view> parts;
  while (!path.empty()) {
    const auto end = path.find('/', 1);
    parts.push_back(path.substr(1, end == std::string_view::npos ? end : end - 1));
    path = end == std::string_view::npos ? std::string_view{} : path.substr(end);
  }
  return parts;
}

std::optional<std::map<std::string, std::string>> values_of(
    const std::vector<std::string_view>& pattern, const std::vector<std::string_view>& path) {
  if (pattern.size() != path.size()) return std::nullopt;
  std::map<std::string, std::string> values;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i].starts_with('{')) {
      if (path[i].empty()) return std::nullopt;
      values[std::string(pattern[i].substr(1, pattern[i].size() - 2))] = path[i];
    } else if (pattern[i] != path[i]) {
      return std::nullopt;
    }
  }
  return values;
}

/// The route's path is logged, never the request's: paths hold tokens.
void log_call(const Call& call, const Match& found, double ms) {
  spdlog::info("{} {} {} {:.1f} ms", call.request.method,
               found.route != nullptr ? found.route->path : "(no route)", call.response.status, ms);
}

/// Checks permission and calls the handler; `reader` is null for methods without a body.
void answer(Service& service, const httplib::Request& request, httplib::Response& response,
            const httplib::ContentReader* reader) {
  const auto start = std::chrono::steady_clock::now();
  Call call{service, request, response};
  Match found = match(request.method, request.path);
  try {
    check_text(request);
    if (found.route == nullptr) {
      if (found.allowed.empty() || request.path.size() > longest_path) throw nothing_here();
      response.set_header("Allow", found.allowed);
      throw Error("not_allowed", "allowed here: " + found.allowed, "");
    }
    call.path = std::move(found.path);
    check_permission(service, *found.route, request);
    if (reader != nullptr) call.body = read_body(request, *reader, found.route->largest_body);
    found.route->handle(call);
  } catch (...) {
    const Error error = error_of(std::current_exception());
    send_error(response, error);
    const auto* path = found.route != nullptr ? found.route->path.c_str() : "(no route)";
    if (response.status >= 500)
      spdlog::warn("{} {} failed: {} ({})", request.method, path, error.what(), error.code);
  }
  set_security_headers(response);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  service.metrics.count(found.route != nullptr ? found.route->path : "", response.status,
                        elapsed.count());
  log_call(call, found, elapsed.count());
}

}  // namespace

nlohmann::json Call::json() const {
  return body.empty() ? nlohmann::json::object() : parse_json(body);
}

const std::vector<Route>& routes() {
  static const std::vector<Route> table = [] {
    std::vector<Route> all;
    add_scene_routes(all);
    add_technique_routes(all);
    add_render_routes(all);
    add_image_routes(all);
    add_sweep_routes(all);
    add_experiment_routes(all);
    add_study_routes(all);
    add_picture_routes(all);
    add_export_routes(all);
    add_qr_code_routes(all);
    add_template_routes(all);
    add_people_routes(all);
    add_enrolment_routes(all);
    add_participant_routes(all);
    add_page_routes(all);
    add_document_routes(all);
    return all;
  }();
  return table;
}

Match match(std::string_view method, std::string_view path) {
  struct Entry {
    const Route* route;
    std::vector<std::string_view> pattern;
  };
  static const std::vector<Entry> entries = [] {
    std::vector<Entry> all;
    for (const auto& route : routes()) all.push_back({&route, segments(route.path)});
    return all;
  }();
  if (method == "HEAD") method = "GET";
  const auto parts = segments(path);
  Match found;
  for (const auto& entry : entries) {
    auto values = values_of(entry.pattern, parts);
    if (!values) continue;
    if (entry.route->method == method) return {entry.route, std::move(*values), {}};
    found.allowed += (found.allowed.empty() ? "" : ", ") + entry.route->method;
  }
  return found;
}

std::vector<std::string> methods_of_routes() {
  std::set<std::string> methods{"HEAD"};
  for (const auto& route : routes()) methods.insert(route.method);
  return {methods.begin(), methods.end()};
}

void install(httplib::Server& server, Service& service) {
  // Requests without a body are answered here, before the library tries its patterns; for the
  // others it has yet to hand out the body.
  server.set_pre_routing_handler([&](const httplib::Request& request, httplib::Response& response) {
    if (may_have_body(request.method)) return httplib::Server::HandlerResponse::Unhandled;
    answer(service, request, response, nullptr);
    return httplib::Server::HandlerResponse::Handled;
  });
  const auto with_body = [&](const httplib::Request& request, httplib::Response& response,
                             const httplib::ContentReader& reader) {
    answer(service, request, response, &reader);
  };
  const std::string anything = "[\\s\\S]*";
  server.Post(anything, with_body);
  server.Put(anything, with_body);
  server.Delete(anything, with_body);
  server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
    if (response.has_header("Content-Type") || response.status == 304) return;
    // The library answers by itself what it could not parse.
    const Error error = response.status >= 500   ? Error("internal", "the server failed")
                        : response.status == 404 ? nothing_here()
                                                 : bad_value("", "the request cannot be read");
    const int status = response.status;
    send_error(response, error);
    response.status = status;
    set_security_headers(response);
  });
  server.set_exception_handler(
      [](const httplib::Request&, httplib::Response& response, std::exception_ptr failure) {
        send_error(response, error_of(failure));
      });
}

}  // namespace penumbra::server::http
