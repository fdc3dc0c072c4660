#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "server/http/routes.h"

namespace penumbra::server::http {

/// Writes server-sent events (HTML standard, 9.2); every call returns whether the client still
/// reads.
class EventSink {
 public:
  explicit EventSink(httplib::DataSink& sink_) : sink(sink_) {}
  bool send(const std::string& event, const nlohmann::json& data);
  bool keep_alive();

 private:
  httplib::DataSink& sink;
};

/// Answers with a stream, one of a bounded number (busy beyond); `next` waits about a second at
/// most, writes what is new, and returns false to end it.
void send_events(Call& call, std::function<bool(EventSink&)> next);

}  // namespace penumbra::server::http
