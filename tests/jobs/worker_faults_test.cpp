// Workers that crash, hang, stop reading or are given too much: what becomes of their pictures and
// of all others.
#include "tests/jobs/render_service_fixture.h"

namespace penumbra::server {
namespace {

TEST_F(RenderServiceTest, tries_a_crashed_render_once_more) {
  start();
  EXPECT_EQ(ended(request(64, Behaviour::crashes_once)).status, "done");
  EXPECT_EQ(log().size(), 2u);
  EXPECT_EQ(log("start").size(), 2u);
}

TEST_F(RenderServiceTest, replaces_a_worker_that_lost_its_device) {
  start();
  EXPECT_EQ(ended(request(64, Behaviour::loses_device_once)).status, "done");
  EXPECT_EQ(log("start").size(), 2u);
}

TEST_F(RenderServiceTest, fails_a_render_that_crashes_twice_and_serves_the_others) {
  start();
  const RenderRecord crashed = ended(request(64, Behaviour::crashes));
  EXPECT_EQ(crashed.status, "failed");
  EXPECT_EQ(crashed.error.at("code"), "device");
  EXPECT_THAT(crashed.error.at("message").get<std::string>(), testing::HasSubstr("signal 6"));
  EXPECT_EQ(service->find(crashed.id)->status, "failed");
  EXPECT_EQ(service->artefact(crashed.id, "image.png"), nullptr);
  EXPECT_EQ(ended(request(65)).status, "done");
}

TEST_F(RenderServiceTest, refuses_what_ended_two_workers_until_it_is_started_again) {
  start();
  EXPECT_EQ(ended(request(64, Behaviour::crashes)).status, "failed");
  EXPECT_EQ(ended(request(65)).status, "done");  // the next worker is well
  EXPECT_EQ(service->statistics().at("refused_pictures"), 1);
  const auto deaths = service->statistics().at("worker_deaths");
  EXPECT_EQ(deaths, 2);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(refusal_of(request(64, Behaviour::crashes)), "unsupported");
  EXPECT_EQ(service->statistics().at("worker_deaths"), deaths);
  service.reset();
  start();
  EXPECT_EQ(ended(request(64, Behaviour::crashes)).error.at("code"), "device");
}

TEST_F(RenderServiceTest, does_not_blame_a_picture_for_a_worker_that_died_before_it) {
  start();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(ended(request(64 + i)).status, "done");
    ::kill(process_of_worker(), SIGKILL);
    // It dies at once, and is seen to at the next look.
    const auto deadline = steady_clock::now() + std::chrono::seconds(30);
    while (service->statistics().at("worker_deaths") != i + 1 && steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(ended(request(80)).status, "done");
  EXPECT_EQ(service->statistics().at("retries"), 0);
}

TEST_F(RenderServiceTest, has_a_fresh_worker_once_one_that_has_drawn_rests) {
  options.fresh_after_s = 0.1;
  start();
  const auto started = [this] { return service->statistics().at("workers_started"); };
  EXPECT_EQ(ended(request(64)).status, "done");
  const auto deadline = steady_clock::now() + std::chrono::seconds(30);
  while (started() != 2 && steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  // The fresh one has drawn nothing and stays.
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_EQ(started(), 2);
  EXPECT_EQ(service->statistics().at("workers_alive"), 1);
  EXPECT_EQ(service->statistics().at("worker_deaths"), 0);
  EXPECT_EQ(ended(request(65)).status, "done");
}

TEST_F(RenderServiceTest, refuses_what_the_device_cannot_hold_before_a_worker_sees_it) {
  ::setenv(
      "STAND_IN_LIMITS",
      R"({"memory":4000000000,"light":2147483648,"storage_buffer":134217728,"image_extent":16384})",
      1);
  start();
  for (const char* technique : {"evsm", "esm", "vsm", "msm", "savsm"}) {
    json body = request(24);
    body["height"] = 24;
    body["technique"] = technique;
    body["parameters"] = {{"map_size", 16384}};
    EXPECT_EQ(refusal_of(body), "unsupported") << technique;
    body["parameters"]["map_size"] = 1024;
    EXPECT_EQ(ended(body).status, "done") << technique;
  }
  // Its pixels alone are a gigabyte, and light before encoding four more.
  json large = request(16384);
  large["height"] = 16384;
  const std::string id = ended(large).id;
  try {
    service->artefact(id, "image.exr");
    ADD_FAILURE() << "five gigabytes were asked of a worker that has four";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "unsupported");
    EXPECT_EQ(error.field, "width");
  }
  EXPECT_EQ(log().size(), 6u);
  EXPECT_EQ(service->statistics().at("worker_deaths"), 0);
}

TEST_F(RenderServiceTest, keeps_its_deadline_with_a_worker_that_stopped_reading) {
  ::setenv("STAND_IN_PADDING", "1000000", 1);  // the reference is more than a pipe holds
  options.deadline_s = 1.0;
  start();
  EXPECT_EQ(ended(measured(64)).status, "done");
  ::kill(process_of_worker(), SIGSTOP);
  json other = measured(64);
  other["seed"] = 2;
  const auto begin = steady_clock::now();
  const RenderRecord stuck = ended(other);
  EXPECT_EQ(stuck.status, "failed");
  EXPECT_EQ(stuck.error.at("code"), "deadline");
  EXPECT_LT(steady_clock::now() - begin, std::chrono::seconds(20));
  EXPECT_EQ(ended(request(65)).status, "done");
}

TEST_F(RenderServiceTest, cancels_and_ends_with_a_worker_that_stopped_reading) {
  ::setenv("STAND_IN_PADDING", "1000000", 1);
  start();
  EXPECT_EQ(ended(measured(64)).status, "done");
  for (int seed = 2; seed < 4; ++seed) {
    ::kill(process_of_worker(), SIGSTOP);
    json other = measured(64);
    other["seed"] = seed;
    const std::string id = service->submit(other).id;
    while (service->find(id)->status == "queued") std::this_thread::yield();
    const auto begin = steady_clock::now();
    if (seed == 2) {
      EXPECT_TRUE(service->release(id, {""}));
      EXPECT_EQ(service->wait(id, patience_s)->status, "cancelled");
      EXPECT_EQ(ended(request(65)).status, "done");  // a new worker
    } else {
      service->drain(0.1);
      EXPECT_EQ(service->find(id)->status, "cancelled");
    }
    EXPECT_LT(steady_clock::now() - begin, std::chrono::seconds(10));
  }
}

TEST_F(RenderServiceTest, stops_a_hanging_render_at_its_deadline) {
  options.deadline_s = 0.5;
  start();
  const auto begin = steady_clock::now();
  const RenderRecord hung = ended(request(64, Behaviour::hangs));
  EXPECT_EQ(hung.status, "failed");
  EXPECT_EQ(hung.error.at("code"), "deadline");
  EXPECT_LT(steady_clock::now() - begin, std::chrono::seconds(30));
  EXPECT_EQ(ended(request(65)).status, "done");
}

TEST_F(RenderServiceTest, takes_nonsense_from_a_worker_for_a_crash) {
  start();
  const RenderRecord record = ended(request(64, Behaviour::talks_nonsense));
  EXPECT_EQ(record.status, "failed");
  EXPECT_EQ(record.error.at("code"), "device");
}

TEST_F(RenderServiceTest, passes_on_why_a_worker_refuses_and_keeps_the_worker) {
  start();
  const RenderRecord record = ended(request(64, Behaviour::refuses));
  EXPECT_EQ(record.status, "failed");
  EXPECT_EQ(record.error.at("code"), "unsupported");
  EXPECT_EQ(record.error.at("field"), "lights");
  EXPECT_EQ(ended(request(65)).status, "done");
  EXPECT_EQ(log("start").size(), 1u);
}

TEST_F(RenderServiceTest, opens_a_breaker_when_no_worker_starts) {
  ::setenv("STAND_IN_REFUSES_TO_START", "1", 1);
  start();
  const auto deadline = steady_clock::now() + std::chrono::seconds(30);
  while (!service->statistics().at("breaker_open") && steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(service->statistics().at("breaker_open"));
  try {
    service->submit(request(64));
    FAIL() << "a request was taken that nobody can draw";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "busy");
    EXPECT_THAT(error.what(), testing::HasSubstr("status 3"));
  }
  // It waits between tries: far fewer starts than a second holds.
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_LE(log("start").size(), 5u);
}

TEST_F(RenderServiceTest, ends_what_waits_where_no_worker_can_be_had) {
  start();
  // Two pictures that crash twice open the breaker; a third waits behind them.
  const std::string first = service->submit(request(64, Behaviour::crashes)).id;
  const std::string second = service->submit(request(65, Behaviour::crashes)).id;
  const std::string third = service->submit(request(66)).id;
  const auto begin = steady_clock::now();
  EXPECT_EQ(service->wait(first, patience_s)->error.at("code"), "device");
  EXPECT_EQ(service->wait(second, patience_s)->error.at("code"), "busy");
  EXPECT_EQ(service->wait(third, patience_s)->error.at("code"), "busy");
  EXPECT_LT(steady_clock::now() - begin, std::chrono::seconds(20));
  // The breaker closes after half a second, and all goes on.
  RenderRecord later;
  while (later.status != "done" && steady_clock::now() - begin < std::chrono::seconds(30)) {
    try {
      later = ended(request(66));
    } catch (const Error& error) {
      EXPECT_EQ(error.code, "busy");
      EXPECT_FALSE(service->trouble().empty());
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  EXPECT_EQ(later.status, "done");
  EXPECT_EQ(service->trouble(), "");
}

}  // namespace
}  // namespace penumbra::server
