#pragma once

#include <exception>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/error.h"

namespace httplib {
struct Request;
struct Response;
}  // namespace httplib

namespace penumbra::server::http {

/// HTTP state of an Error's code; 500 for codes that no front end knows.
int status_of(const std::string& code);

/// The body of every failure: {"error":{"code","message","field"}}.
nlohmann::json error_body(const Error& error);

void send_json(httplib::Response& response, int status, const nlohmann::json& body);

/// True where the client has what goes by this tag already; the answer then is 304, without body.
/// Sets the tag in either case.
bool client_has(const httplib::Request& request, httplib::Response& response,
                const std::string& tag);

/// Error body, state, and Retry-After where trying again helps.
void send_error(httplib::Response& response, const Error& error);

/// Headers of every answer: what browsers may do with it, and that it is not kept.
void set_security_headers(httplib::Response& response);

/// A whole answer as it goes out, for a request that is refused before it is read. The connection
/// ends after it. `methods` are named where the method was wrong.
std::string refusal_text(const Error& error, const std::vector<std::string>& methods,
                         bool with_body);

/// What is answered for an exception that reached the edge of a request; unknown ones are logged.
Error error_of(std::exception_ptr failure);

/// The same for everything that does not exist, so that it does not show what nearly does.
Error nothing_here();

}  // namespace penumbra::server::http
