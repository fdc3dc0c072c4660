#pragma once

#include <httplib.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::server::http {

struct Service;

/// Who may call a route.
enum class Access {
  anyone,      ///< what participants need; their tokens and codes are in the path
  laboratory,  ///< anyone where only this machine reaches the server, otherwise as `researcher`
  researcher,  ///< holder of the access token, by header or session cookie
};

/// One request on its way through a handler.
struct Call {
  Service& service;
  const httplib::Request& request;
  httplib::Response& response;
  std::map<std::string, std::string> path = {};  ///< values of the {names} in the route's path
  std::string body = {};

  /// The body as JSON; an empty object for an empty body. Throws bad_value (field body), too_large
  /// for deep nesting.
  nlohmann::json json() const;
};

/// Largest body that a route takes unless it says otherwise: bytes after decompression.
inline constexpr std::size_t small_body = 64 << 10;

struct Route {
  std::string method;  ///< GET, POST, PUT or DELETE; HEAD goes where GET goes
  std::string path;    ///< as in schema/openapi.yaml: /api/v1/scenes/{id}
  Access access = Access::anyone;
  void (*handle)(Call&) = nullptr;
  std::size_t largest_body = small_body;
};

/// The only table of routes: it is served, and compared with schema/openapi.yaml by a test.
const std::vector<Route>& routes();

// One of these per resource.
void add_scene_routes(std::vector<Route>& table);
void add_technique_routes(std::vector<Route>& table);
void add_render_routes(std::vector<Route>& table);
void add_image_routes(std::vector<Route>& table);
void add_sweep_routes(std::vector<Route>& table);
void add_experiment_routes(std::vector<Route>& table);
void add_study_routes(std::vector<Route>& table);
void add_picture_routes(std::vector<Route>& table);
void add_export_routes(std::vector<Route>& table);
void add_qr_code_routes(std::vector<Route>& table);
void add_template_routes(std::vector<Route>& table);
void add_people_routes(std::vector<Route>& table);
void add_enrolment_routes(std::vector<Route>& table);
void add_participant_routes(std::vector<Route>& table);
void add_page_routes(std::vector<Route>& table);
void add_document_routes(std::vector<Route>& table);

struct Match {
  const Route* route = nullptr;
  std::map<std::string, std::string> path;
  std::string allowed;  ///< methods of this path, where only the method was wrong
};
Match match(std::string_view method, std::string_view path);

/// Methods that some route takes, and HEAD.
std::vector<std::string> methods_of_routes();

/// Makes the server answer the table's routes, and everything else with the uniform 404.
void install(httplib::Server& server, Service& service);

}  // namespace penumbra::server::http
