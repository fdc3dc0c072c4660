#include "server/http/operations.h"

#include "server/http/reply.h"
#include "server/http/service.h"

namespace penumbra::server::http {

void install_operations(httplib::Server& server, Service& service) {
  server.Get("/healthz", [](const httplib::Request&, httplib::Response& response) {
    response.set_content("ok\n", "text/plain");
  });
  server.Get("/readyz", [&](const httplib::Request&, httplib::Response& response) {
    const auto reason = service.not_ready();
    response.status = reason.empty() ? 200 : 503;
    response.set_content(reason.empty() ? "ready\n" : reason + "\n", "text/plain");
  });
  server.Get("/metrics", [&](const httplib::Request&, httplib::Response& response) {
    response.set_content(service.metrics.text(service.gauges()), "text/plain; version=0.0.4");
  });
  server.set_exception_handler(
      [](const httplib::Request&, httplib::Response& response, std::exception_ptr failure) {
        send_error(response, error_of(failure));
      });
}

}  // namespace penumbra::server::http
