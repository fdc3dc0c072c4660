#pragma once

#include <httplib.h>

namespace penumbra::server::http {

struct Service;

/// Makes the server answer /healthz (the process lives), /readyz (requests are served; 503 with the
/// reason where not) and /metrics (Prometheus text).
void install_operations(httplib::Server& server, Service& service);

}  // namespace penumbra::server::http
