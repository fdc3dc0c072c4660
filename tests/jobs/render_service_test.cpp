#include "server/jobs/render_service.h"

#include <gmock/gmock.h>
#include <stdlib.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "renderer/error.h"
#include "server/jobs/task.h"
#include "tests/jobs/temporary_folder.h"
#include "tests/stand_in_worker/behaviour.h"

namespace penumbra::server {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

constexpr double patience_s = 60.0;  // a loaded machine may take its time

/// A service over stand-in workers in a folder of its own.
class RenderServiceTest : public testing::Test {
 protected:
  RenderServiceTest() {
    options.data = folder.path() / "data";
    options.worker_command = {PENUMBRA_STAND_IN_WORKER};
    ::setenv("STAND_IN_LOG", log_path().c_str(), 1);
    ::unsetenv("STAND_IN_REFUSES_TO_START");
  }

  std::filesystem::path log_path() const { return folder.path() / "log"; }

  /// Tasks that began, or the lines that begin with `what`.
  std::vector<std::string> log(const std::string& what = "begin") const {
    std::vector<std::string> lines;
    std::ifstream file(log_path());
    for (std::string line; std::getline(file, line);)
      if (line.starts_with(what)) lines.push_back(line);
    return lines;
  }

  void start() { service = make_render_service(options); }

  static json request(int width, Behaviour behaviour = Behaviour::behaves, int takes_ms = 1) {
    return {{"scene", "half-plane"},
            {"technique", "none"},
            {"width", width},
            {"seed", static_cast<int>(behaviour)},
            {"light_samples", takes_ms}};
  }
  static json measured(int width) {
    json body = request(width);
    body["measure"] = true;
    return body;
  }

  RenderRecord ended(const json& body) {
    return *service->wait(service->submit(body).id, patience_s);
  }

  TemporaryFolder folder;
  RenderServiceOptions options;
  std::unique_ptr<RenderService> service;
};

std::string image_of(const std::string& id) {
  return "image.png of " + id;
}

TEST_F(RenderServiceTest, draws_once_and_answers_from_its_cache_afterwards) {
  start();
  const RenderRecord first = ended(request(64));
  EXPECT_EQ(first.status, "done");
  EXPECT_EQ(first.device.at("name"), "stand-in");
  EXPECT_TRUE(first.error.is_null());
  EXPECT_EQ(service->artefact(first.id, "image.png"), image_of(first.id));

  EXPECT_EQ(service->submit(request(64)).status, "done");
  EXPECT_EQ(log().size(), 1u);
}

TEST_F(RenderServiceTest, knows_its_renders_after_a_restart) {
  start();
  const std::string id = ended(request(64)).id;
  service.reset();
  start();
  EXPECT_EQ(service->find(id)->status, "done");
  EXPECT_EQ(service->submit(request(64)).status, "done");
  EXPECT_EQ(service->artefact(id, "image.png"), image_of(id));
  EXPECT_EQ(log().size(), 1u);
}

TEST_F(RenderServiceTest, ends_while_its_workers_are_still_starting) {
  options.workers = 2;
  for (int i = 0; i < 50; ++i) {
    start();
    std::this_thread::sleep_for(std::chrono::microseconds(i * 100));
    service.reset();
  }
}

TEST_F(RenderServiceTest, draws_once_for_two_hundred_who_ask_for_the_same) {
  options.workers = 2;
  start();
  std::vector<std::thread> people;
  std::atomic<int> served = 0;
  for (int i = 0; i < 200; ++i)
    people.emplace_back([&] {
      if (ended(request(64, Behaviour::behaves, 300)).status == "done") ++served;
    });
  for (std::thread& person : people) person.join();
  EXPECT_EQ(served, 200);
  EXPECT_EQ(log().size(), 1u);
}

TEST_F(RenderServiceTest, tells_progress_while_it_draws) {
  start();
  RenderRecord record = service->submit(request(64, Behaviour::behaves, 500));
  std::vector<double> seen;
  while (record.status == "queued" || record.status == "running") {
    record = *service->wait_change(record.id, record, patience_s);
    seen.push_back(record.progress);
  }
  EXPECT_THAT(seen, testing::Contains(0.5));
  EXPECT_EQ(seen.back(), 1.0);
}

TEST_F(RenderServiceTest, refuses_when_the_queue_is_full_and_finishes_what_it_took) {
  options.queue_limit = 3;
  start();
  const std::string running = service->submit(request(64, Behaviour::behaves, 700)).id;
  while (service->find(running)->status == "queued") std::this_thread::yield();
  std::vector<std::string> taken;
  for (int i = 0; i < 3; ++i) taken.push_back(service->submit(request(65 + i)).id);
  try {
    service->submit(request(100));
    FAIL() << "a fourth was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, "busy");
  }
  for (const std::string& id : taken) EXPECT_EQ(service->wait(id, patience_s)->status, "done");
}

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
  EXPECT_EQ(service->artefact(crashed.id, "image.png"), std::nullopt);
  EXPECT_EQ(ended(request(65)).status, "done");
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

TEST_F(RenderServiceTest, cancels_what_nobody_else_waits_for) {
  start();
  const std::string id = service->submit(request(64, Behaviour::hangs)).id;
  service->submit(request(64, Behaviour::hangs));  // a second person wants it too
  while (service->find(id)->status == "queued") std::this_thread::yield();
  EXPECT_TRUE(service->cancel(id));
  EXPECT_EQ(service->find(id)->status, "running");
  EXPECT_TRUE(service->cancel(id));
  EXPECT_EQ(service->wait(id, patience_s)->status, "cancelled");
  EXPECT_FALSE(service->cancel(std::string(32, '0')));
  EXPECT_EQ(ended(request(65)).status, "done");
}

TEST_F(RenderServiceTest, cancels_what_still_waits_without_a_worker) {
  start();
  service->submit(request(64, Behaviour::behaves, 300));
  const std::string id = service->submit(request(65)).id;
  EXPECT_TRUE(service->cancel(id));
  EXPECT_EQ(service->find(id)->status, "cancelled");
}

TEST_F(RenderServiceTest, draws_an_altered_picture_again) {
  start();
  const std::string id = ended(request(64)).id;
  service.reset();
  const auto file = options.data / "artefacts" / id.substr(0, 2) / id / "image.png";
  ASSERT_TRUE(std::filesystem::exists(file));
  std::ofstream(file) << "something else";
  start();
  EXPECT_EQ(service->artefact(id, "image.png"), image_of(id));
  EXPECT_EQ(log().size(), 2u);
}

TEST_F(RenderServiceTest, makes_further_files_of_a_picture_when_they_are_asked_for) {
  start();
  const std::string id = ended(request(64)).id;
  EXPECT_EQ(service->artefact(id, "visibility.exr"), "visibility.exr of " + id);
  EXPECT_EQ(service->artefact(id, "secret.txt"), std::nullopt);
  EXPECT_EQ(service->artefact(std::string(32, '0'), "image.png"), std::nullopt);
  EXPECT_THAT(log().back(), testing::HasSubstr("[\"visibility.exr\"]"));
}

TEST_F(RenderServiceTest, measures_against_a_reference_that_is_drawn_once) {
  start();
  const RenderRecord first = ended(measured(64));
  EXPECT_EQ(first.quality.at("rms_y"), 3.0);
  EXPECT_EQ(first.cost.at("frame_ms").at("frames"), 9);
  ASSERT_EQ(log().size(), 2u);
  EXPECT_THAT(log()[0], testing::HasSubstr("noise"));
  EXPECT_THAT(log()[1], testing::HasSubstr("with reference"));

  // Another technique in the same view shares it; here another preset of parameters.
  json other = measured(64);
  other["parameters"] = {{"gamma", "correct"}};
  other["seed"] = 2;
  ended(other);
  EXPECT_EQ(log().size(), 3u);
}

TEST_F(RenderServiceTest, adds_a_measurement_to_a_picture_that_is_there) {
  start();
  const RenderRecord plain = ended(request(64));
  EXPECT_TRUE(plain.cost.is_null());
  const RenderRecord with_cost = ended(measured(64));
  EXPECT_EQ(with_cost.id, plain.id);
  EXPECT_FALSE(with_cost.cost.is_null());
  EXPECT_EQ(service->submit(measured(64)).status, "done");

  // Another number of frames is another measurement of the same picture.
  json longer = measured(64);
  longer["frames"] = 20;
  EXPECT_EQ(ended(longer).cost.at("frame_ms").at("frames"), 20);
}

TEST_F(RenderServiceTest, lets_nothing_run_beside_a_measurement) {
  options.workers = 3;
  start();
  std::vector<std::string> ids;
  for (int i = 0; i < 4; ++i)
    ids.push_back(service->submit(request(64 + i, Behaviour::behaves, 60)).id);
  json body = measured(200);
  body["light_samples"] = 60;
  const std::string alone = service->submit(body).id;
  ids.push_back(alone);
  for (int i = 0; i < 4; ++i)
    ids.push_back(service->submit(request(74 + i, Behaviour::behaves, 60)).id);
  for (const std::string& id : ids) EXPECT_EQ(service->wait(id, patience_s)->status, "done");

  // Between the measurement's beginning and end stands no other line.
  const std::vector<std::string> lines = log("");
  const auto begin = std::find_if(lines.begin(), lines.end(), [&](const std::string& line) {
    return line.starts_with("begin " + alone);
  });
  ASSERT_NE(begin, lines.end());
  EXPECT_EQ(*(begin + 1), "end " + alone);
}

TEST_F(RenderServiceTest, lets_running_work_finish_when_it_drains) {
  start();
  const std::string running = service->submit(request(64, Behaviour::behaves, 300)).id;
  while (service->find(running)->status == "queued") std::this_thread::yield();
  const std::string waiting = service->submit(request(65)).id;
  service->drain(patience_s);
  EXPECT_EQ(service->find(running)->status, "done");
  EXPECT_EQ(service->find(waiting)->error.at("code"), "busy");
  EXPECT_THROW(service->submit(request(66)), Error);
}

TEST_F(RenderServiceTest, ends_hanging_work_at_the_draining_deadline) {
  start();
  const std::string id = service->submit(request(64, Behaviour::hangs)).id;
  while (service->find(id)->status == "queued") std::this_thread::yield();
  service->drain(0.1);
  EXPECT_EQ(service->find(id)->status, "cancelled");
}

}  // namespace
}  // namespace penumbra::server
