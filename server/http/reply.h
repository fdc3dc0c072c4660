#pragma once

#include <exception>
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/error.h"

namespace httplib {
struct Response;
}

namespace penumbra::server::http {

/// HTTP state of an Error's code; 500 for codes that no front end knows.
int status_of(const std::string& code);

/// The body of every failure: {"error":{"code","message","field"}}.
nlohmann::json error_body(const Error& error);

void send_json(httplib::Response& response, int status, const nlohmann::json& body);

/// Error body, state, and Retry-After where trying again helps.
void send_error(httplib::Response& response, const Error& error);

/// Like send_error, then closes the connection: for requests whose body was not read, since what is
/// left of it would be taken for the next request.
void send_error_and_close(httplib::Response& response, const Error& error);

/// What is answered for an exception that reached the edge of a request; unknown ones are logged.
Error error_of(std::exception_ptr failure);

/// The same for everything that does not exist, so that nobody learns what nearly does.
Error nothing_here();

}  // namespace penumbra::server::http
