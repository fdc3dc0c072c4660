// Processes that draw: killed, hung, without memory.
#include <signal.h>

#include "tests/faults/ledger.h"
#include "tests/faults/people.h"

namespace penumbra::faults {
namespace {

class Workers : public testing::Test {
 protected:
  ServerOptions options(std::vector<std::string> arguments = {}) const {
    ServerOptions all;
    all.data = folder.path / "data";
    all.arguments = std::move(arguments);
    return all;
  }

  static std::string post(const ServerProcess& server, const json& request) {
    const auto result = server.client().Post("/api/v1/renders", request.dump(), "application/json");
    EXPECT_TRUE(result && result->status < 300) << (result ? result->body : "no reply");
    return result ? "/api/v1/renders/" + json::parse(result->body).value("id", "") : "";
  }
  static json state(const ServerProcess& server, const std::string& at, const char* wait = "") {
    const auto result = server.client().Get(at + wait);
    return result && result->status == 200 ? json::parse(result->body) : json::object();
  }
  static std::string code_of(const json& record) {
    const json error = record.value("error", json());
    return error.is_object() ? error.value("code", "") : "";
  }
  /// Its record once it is over; a loaded machine may take minutes.
  static json ended(const ServerProcess& server, const std::string& at) {
    json last;
    eventually(
        [&] {
          last = state(server, at, "?wait_s=20");
          const auto status = last.value("status", "");
          return status == "done" || status == "failed" || status == "cancelled";
        },
        180);
    return last;
  }
  static bool draws(const ServerProcess& server, int width) {
    const auto image = server.client().Get(
        "/api/v1/image?scene=half-plane&technique=none&height=16&width=" + std::to_string(width));
    return image && image->status == 200;
  }
  /// Takes a second or more to draw.
  static json long_render(int width = 300) {
    return {{"scene", "boxes"}, {"technique", "reference"}, {"width", width},
            {"height", 300},    {"supersampling", 4},       {"light_samples", 512}};
  }
  static void wait_running(const ServerProcess& server, const std::string& at) {
    EXPECT_TRUE(eventually([&] { return state(server, at).value("status", "") != "queued"; }));
  }

  server::TemporaryFolder folder;
};

TEST_F(Workers, AKilledWorkerIsReplacedAndItsRenderTriedOnce) {
  Fault fault(27, "the worker dies amid a render");
  ServerProcess server(options());
  const auto first_worker = server.worker();
  const auto at = post(server, long_render());
  wait_running(server, at);
  ::kill(first_worker, SIGKILL);
  ++fault.tries;
  EXPECT_EQ(ended(server, at).value("status", ""), "done");
  EXPECT_NE(server.worker(), first_worker);
  // Twice: a typed failure that says when to come back.
  const auto again = post(server, long_render(304));
  for (int i = 0; i < 2; ++i) {
    wait_running(server, again);
    const auto worker = server.worker();
    eventually([&] { return state(server, again).value("status", "") == "running"; }, 5);
    ::kill(worker, SIGKILL);
    ++fault.tries;
    eventually([&] { return server.worker() != worker; }, 10);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
  const auto failed = ended(server, again);
  if (failed.value("status", "") == "failed") {
    const auto image = server.client().Get(again + "/image.png");
    ASSERT_TRUE(image);
    EXPECT_EQ(image->status, 503) << image->body;
    EXPECT_TRUE(image->has_header("Retry-After"));
  } else {
    EXPECT_EQ(failed.value("status", ""), "done") << failed;
  }
  EXPECT_TRUE(draws(server, 20));
  fault.did << "one retry, then " << failed.value("status", "") << "; the next picture was drawn";
}

TEST_F(Workers, AHungWorkerIsKilledAtTheDeadline) {
  Fault fault(28, "the worker hangs amid a render, and before one");
  ServerProcess server(options({"--render-deadline", "6", "--workers", "2"}));
  ASSERT_TRUE(server.wait_metric("penumbra_renders_workers_alive", 2));
  EXPECT_TRUE(draws(server, 16));
  const auto stopped = server.workers();
  ASSERT_EQ(stopped.size(), 2u);
  ::kill(stopped[0], SIGSTOP);
  ++fault.tries;
  // Whichever worker takes them, both end: one drawn, one at its deadline or drawn elsewhere.
  const Stopwatch watch;
  const auto a = post(server, {{"scene", "half-plane"}, {"technique", "none"}, {"width", 20}});
  const auto b = post(server, {{"scene", "half-plane"}, {"technique", "none"}, {"width", 21}});
  int done = 0;
  for (const auto& at : {a, b}) {
    const auto last = ended(server, at);
    if (last.value("status", "") == "done") {
      ++done;
      continue;
    }
    EXPECT_EQ(code_of(last), "deadline") << last;
    EXPECT_EQ(server.client().Get(at + "/image.png")->status, 504);
  }
  EXPECT_GE(done, 1);
  EXPECT_LT(watch.seconds(), 60.0);
  EXPECT_TRUE(draws(server, 22));
  fault.did << done << " of 2 drawn beside it, the other 504 at the deadline";
}

TEST_F(Workers, AWorkerWithoutMemoryCostsOneRequest) {
  Fault fault(29, "the worker may have no more memory");
  ServerProcess server(options());
  const auto worker = server.worker();
  ASSERT_TRUE(draws(server, 16));
  rlimit none{64u << 20, 64u << 20};
  ASSERT_EQ(::prlimit(worker, RLIMIT_AS, &none, nullptr), 0);
  ++fault.tries;
  const auto at = post(server, long_render(600));
  const auto last = ended(server, at);
  EXPECT_TRUE(last.value("status", "") == "done" || last.value("status", "") == "failed") << last;
  EXPECT_TRUE(draws(server, 17));
  fault.did << "that request " << last.value("status", "") << ", the next picture was drawn";
}

TEST_F(Workers, ACrashLoopOpensTheBreakerAndEndsByItself) {
  Fault fault(30, "every worker dies as it starts");
  ServerProcess server(options());
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(3);
  while (std::chrono::steady_clock::now() < until) {
    for (const auto worker : server.workers()) {
      ::kill(worker, SIGKILL);
      ++fault.tries;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const double started = server.metric("penumbra_renders_workers_started");
  EXPECT_LT(started, 15.0);
  const Stopwatch watch;
  EXPECT_TRUE(eventually([&] { return draws(server, 19); }, 60));
  fault.did << started << " workers that said hello in 3 s; drawing again after "
            << static_cast<int>(watch.seconds() * 1000) << " ms";
}

TEST_F(Workers, TheValidationLayerIsSilentForEveryTechnique) {
  Fault fault(31, "every technique under the validation layer");
  ServerProcess server(options({"--validation"}));
  const auto list = server.client().Get("/api/v1/techniques");
  ASSERT_TRUE(list);
  const json techniques = json::parse(list->body)["techniques"];
  for (const auto& technique : techniques) {
    ++fault.tries;
    const auto at = post(server, {{"scene", "half-plane"},
                                  {"technique", technique["id"]},
                                  {"width", 16},
                                  {"height", 16},
                                  {"light_samples", 4}});
    const auto last = ended(server, at);
    EXPECT_EQ(last.value("status", ""), "done") << technique["id"] << last["error"];
  }
  EXPECT_GT(fault.tries, 15);
  EXPECT_EQ(server.log().find("VUID"), std::string::npos);
  fault.did << "a message fails the render: all were drawn. The conformance tests draw every "
               "technique and preset on every scene with the layer on";
}

TEST_F(Workers, PixelsThatAreNoNumberAreCounted) {
  Fault fault(32, "parameters at the ends of their ranges");
  ServerProcess server(options());
  const auto list = server.client().Get("/api/v1/techniques");
  ASSERT_TRUE(list);
  int noted = 0;
  const json techniques = json::parse(list->body)["techniques"];
  for (const auto& technique : techniques) {
    const auto id = technique["id"].get<std::string>();
    if (id != "esm" && id != "evsm" && id != "vsm") continue;
    const json schema = technique.value("parameters", json::object());
    const json properties = schema.contains("properties") ? schema["properties"] : json::object();
    for (const auto& [name, property] : properties.items())
      for (const char* end : {"minimum", "maximum"}) {
        if (!property.contains(end) || name.find("size") != std::string::npos) continue;
        ++fault.tries;
        const auto at = post(server, {{"scene", "half-plane"},
                                      {"technique", id},
                                      {"width", 16},
                                      {"height", 16},
                                      {"parameters", {{name, property[end]}}}});
        const auto last = ended(server, at);
        const auto status = last.value("status", "");
        EXPECT_TRUE(status == "done" || code_of(last) == "unsupported")
            << id << " " << name << end << last;
        if (last["notes"].dump().find("finite") != std::string::npos) ++noted;
      }
  }
  fault.did << "a picture or a typed error each time, " << noted << " pictures with a note of such "
            << "pixels";
}

TEST_F(Workers, AWorkerThatStopsReadingBlocksNothing) {
  Fault fault(28, "the worker stops before it reads a task of megabytes");
  ServerProcess server(options({"--render-deadline", "8"}));
  // The reference is cached, so that the next task carries it.
  json measured = {{"scene", "half-plane"}, {"technique", "none"}, {"width", 500},
                   {"height", 500},         {"measure", true},     {"frames", 1},
                   {"light_samples", 4}};
  const auto first = post(server, measured);
  ASSERT_EQ(ended(server, first).value("status", ""), "done");
  ::kill(server.worker(), SIGSTOP);
  ++fault.tries;
  measured["technique"] = "shadow-map";
  const Stopwatch watch;
  const auto second = post(server, measured);
  const auto last = ended(server, second);
  EXPECT_TRUE(last.value("status", "") == "done" || last.value("status", "") == "failed") << last;
  EXPECT_LT(watch.seconds(), 30.0);
  EXPECT_TRUE(draws(server, 23));
  ::kill(server.worker(), SIGSTOP);
  ++fault.tries;
  measured["technique"] = "pcf";
  post(server, measured);
  const Stopwatch end;
  EXPECT_EQ(server.terminate(60), 0);
  fault.did << "over after " << static_cast<int>(watch.seconds() * 1000)
            << " ms at a deadline of 8 s, a stop took " << static_cast<int>(end.seconds() * 1000)
            << " ms";
}

TEST_F(Workers, PicturesTooLargeForTheDeviceStopNothing) {
  Fault fault(30, "six cheap requests for maps of 16,384 texels");
  ServerProcess server(options());
  ASSERT_TRUE(draws(server, 16));
  const double deaths = server.metric("penumbra_renders_worker_deaths");
  std::vector<std::string> ids;
  for (const char* technique : {"evsm", "esm", "vsm", "msm", "savsm", "evsm"}) {
    const json request = {{"scene", "half-plane"},
                          {"technique", technique},
                          {"width", 24 + fault.tries},
                          {"height", 24},
                          {"parameters", {{"map_size", 16384}}}};
    const auto result = server.client().Post("/api/v1/renders", request.dump(), "application/json");
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->status == 422 || result->status < 300) << result->status << result->body;
    ++fault.tries;
  }
  const Stopwatch watch;
  EXPECT_TRUE(draws(server, 18));
  EXPECT_LT(watch.seconds(), 60.0);
  EXPECT_EQ(server.metric("penumbra_renders_worker_deaths"), deaths);
  fault.did << "no worker died, a good request after them took "
            << static_cast<int>(watch.seconds() * 1000) << " ms";
}

}  // namespace
}  // namespace penumbra::faults
