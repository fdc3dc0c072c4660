#include "server/http/event_stream.h"
#include "scenes/json_text.h"

#include "server/http/service.h"

namespace penumbra::server::http {

bool EventSink::send(const std::string& event, const nlohmann::json& data) {
  const std::string text = "event: " + event + "\ndata: " + scenes::json_text(data) + "\n\n";
  return sink.write(text.data(), text.size());
}

bool EventSink::keep_alive() {
  constexpr std::string_view comment = ":\n\n";
  return sink.write(comment.data(), comment.size());
}

void send_events(Call& call, std::function<bool(EventSink&)> next) {
  auto place = call.service.waits.take();
  call.response.status = 200;
  call.response.set_header("X-Accel-Buffering", "no");  // nginx passes events on at once
  call.response.set_chunked_content_provider(
      "text/event-stream",
      [next = std::move(next), place = std::move(place)](std::size_t, httplib::DataSink& sink) {
        EventSink events(sink);
        if (!next(events)) sink.done();
        return true;
      });
}

}  // namespace penumbra::server::http
