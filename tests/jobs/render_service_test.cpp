#include "tests/jobs/render_service_fixture.h"

namespace penumbra::server {
namespace {

std::string image_of(const std::string& id) {
  return "image.png of " + id;
}

TEST_F(RenderServiceTest, draws_once_and_answers_from_its_cache_afterwards) {
  start();
  const RenderRecord first = ended(request(64));
  EXPECT_EQ(first.status, "done");
  EXPECT_EQ(first.device.at("name"), "stand-in");
  EXPECT_TRUE(first.error.is_null());
  EXPECT_EQ(*service->artefact(first.id, "image.png"), image_of(first.id));

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
  EXPECT_EQ(*service->artefact(id, "image.png"), image_of(id));
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

TEST_F(RenderServiceTest, draws_an_altered_picture_again) {
  start();
  const std::string id = ended(request(64)).id;
  service.reset();
  const auto file = options.data / "artefacts" / id.substr(0, 2) / id / "image.png";
  ASSERT_TRUE(std::filesystem::exists(file));
  std::ofstream(file) << "something else";
  start();
  EXPECT_EQ(*service->artefact(id, "image.png"), image_of(id));
  EXPECT_EQ(log().size(), 2u);
}

TEST_F(RenderServiceTest, makes_further_files_of_a_picture_when_they_are_asked_for) {
  start();
  const std::string id = ended(request(64)).id;
  EXPECT_EQ(*service->artefact(id, "visibility.exr"), "visibility.exr of " + id);
  EXPECT_EQ(service->artefact(id, "secret.txt"), nullptr);
  EXPECT_EQ(service->artefact(std::string(32, '0'), "image.png"), nullptr);
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

  // Between the measurement's beginning and end is no other line.
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
