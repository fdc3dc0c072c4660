#include <thread>

#include "tests/http/raw_request.h"
#include "tests/http/running_server.h"

namespace penumbra::server::http {
namespace {

using Renders = RunningServer;

TEST_F(Renders, OfKnownPicturesAreAnsweredAtOnce) {
  const auto result = post("/api/v1/renders", {{"scene", "boxes"}, {"technique", "none"}});
  const auto body = body_of(result, 200, "Render");
  EXPECT_EQ(body["status"], "done");
  EXPECT_EQ(result->get_header_value("Location"),
            "/api/v1/renders/" + body["id"].get<std::string>());
}

TEST_F(Renders, OfNewPicturesAreAcceptedAndCanBeWaitedFor) {
  const auto result = post("/api/v1/renders", {{"scene", "slow"}, {"technique", "none"}});
  const auto id = body_of(result, 202, "Render")["id"].get<std::string>();
  EXPECT_EQ(body_of(client->Get("/api/v1/renders/" + id), 200, "Render")["status"], "queued");
  std::thread worker([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    renders->finish(id);
  });
  const auto start = std::chrono::steady_clock::now();
  const auto waited = body_of(client->Get("/api/v1/renders/" + id + "?wait_s=10"), 200, "Render");
  worker.join();
  EXPECT_EQ(waited["status"], "done");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST_F(Renders, WaitNoLongerThanAsked) {
  const auto id = body_of(post("/api/v1/renders", {{"scene", "slow"}, {"technique", "none"}}), 202,
                          "Render")["id"]
                      .get<std::string>();
  EXPECT_EQ(body_of(client->Get("/api/v1/renders/" + id + "?wait_s=0.1"), 200, "Render")["status"],
            "queued");
  for (const auto* text : {"61", "-1", "nan", "inf", "x", "1e999"})
    EXPECT_EQ(error_of(client->Get("/api/v1/renders/" + id + "?wait_s=" + text), 400), "bad_value");
}

TEST_F(Renders, GiveTheirPictureToBeKeptForEver) {
  const auto body =
      body_of(post("/api/v1/renders", {{"scene", "boxes"}, {"technique", "none"}}), 200, "Render");
  const auto image = client->Get(body["links"]["image"].get<std::string>());
  ASSERT_TRUE(image);
  EXPECT_EQ(image->status, 200);
  EXPECT_EQ(image->body, FakeRenders::png_of("none"));
  EXPECT_EQ(image->get_header_value("Content-Type"), "image/png");
  EXPECT_EQ(image->get_header_value("ETag"), '"' + body["id"].get<std::string>() + '"');
  EXPECT_NE(image->get_header_value("Cache-Control").find("immutable"), std::string::npos);
  const auto again = client->Get(body["links"]["image"].get<std::string>(),
                                 {{"If-None-Match", image->get_header_value("ETag")}});
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 304);
  EXPECT_TRUE(again->body.empty());
}

TEST_F(Renders, OfAQueryAnswerThePicture) {
  const auto image = client->Get("/api/v1/image?scene=boxes&technique=esm&width=64");
  ASSERT_TRUE(image);
  EXPECT_EQ(image->status, 200);
  EXPECT_EQ(image->body, FakeRenders::png_of("esm"));
}

TEST_F(Renders, ThatFailedSayWhy) {
  const auto body =
      body_of(post("/api/v1/renders", {{"scene", "broken"}, {"technique", "none"}}), 200, "Render");
  EXPECT_EQ(body["status"], "failed");
  EXPECT_EQ(body["error"]["code"], "deadline");
  EXPECT_EQ(error_of(client->Get("/api/v1/image?scene=broken&technique=none"), 504), "deadline");
}

TEST_F(Renders, WithBadValuesNameTheField) {
  const auto result = post("/api/v1/renders", {{"scene", "wide"}, {"technique", "none"}});
  EXPECT_EQ(error_of(result, 400), "bad_value");
  EXPECT_EQ(field_of(result), "width");
}

TEST_F(Renders, BeyondTheQueueAreToldToTryAgain) {
  const auto result = post("/api/v1/renders", {{"scene", "full"}, {"technique", "none"}});
  EXPECT_EQ(error_of(result, 503), "busy");
  EXPECT_FALSE(result->get_header_value("Retry-After").empty());
}

TEST_F(Renders, CanBeCancelledByTheConnectionThatAsked) {
  const auto id = body_of(post("/api/v1/renders", {{"scene", "slow"}, {"technique", "none"}}), 202,
                          "Render")["id"]
                      .get<std::string>();
  EXPECT_EQ(body_of(client->Delete("/api/v1/renders/" + id), 200, "Render")["status"], "cancelled");
  EXPECT_EQ(error_of(client->Get("/api/v1/renders/" + id + "/image.png"), 409), "conflict");
  EXPECT_EQ(error_of(client->Delete("/api/v1/renders/nothing"), 404), "not_found");
}

TEST_F(Renders, AreKeptForClientsThatOnlyEndedTheirSending) {
  RawConnection half(server->port());
  half.send("GET /api/v1/image?scene=slow&technique=half HTTP/1.1\r\nHost: x\r\n\r\n");
  half.stop_sending();
  std::this_thread::sleep_for(std::chrono::milliseconds(2500));
  const auto id = body_of(post("/api/v1/renders", {{"scene", "slow"}, {"technique", "half"}}), 202,
                          "Render")["id"]
                      .get<std::string>();
  EXPECT_EQ(renders->find(id)->status, "queued");
  renders->finish(id);
  EXPECT_EQ(half.read(4.0).status(), 200);
}

TEST_F(Renders, CanBeCancelledByTheirLeaseFromAnywhere) {
  const auto asked =
      body_of(post("/api/v1/renders", {{"scene", "slow"}, {"technique", "none"}}), 202, "Render");
  const std::string path = asked["links"]["self"];
  EXPECT_EQ(asked["links"]["cancel"], path + "?lease=" + asked["lease"].get<std::string>());
  // It is told to the one who posted, and is nowhere else.
  EXPECT_FALSE(body_of(client->Get(path), 200, "Render").contains("lease"));
  httplib::Client other("127.0.0.1", server->port());
  EXPECT_EQ(
      body_of(other.Delete(asked["links"]["cancel"].get<std::string>()), 200, "Render")["status"],
      "cancelled");
}

TEST_F(Renders, CanBeCancelledByTheResearcherUnlessTheServerItselfNeedsThem) {
  const auto asked =
      body_of(post("/api/v1/renders", {{"scene", "slow"}, {"technique", "none"}}), 202, "Render");
  const std::string path = asked["links"]["self"];
  renders->submit(asked["request"], {Priority::publication, "study", {"publication"}, {}});
  EXPECT_EQ(body_of(researcher->Delete(path), 200, "Render")["status"], "queued");
  EXPECT_EQ(error_of(researcher->Delete(path), 403), "forbidden");
  renders->finish(asked["id"]);
  EXPECT_EQ(body_of(researcher->Delete(path), 200, "Render")["status"], "done");
}

TEST_F(Renders, AreNotEndedByStrangers) {
  const auto asked =
      body_of(post("/api/v1/renders", {{"scene", "slow"}, {"technique", "none"}}), 202, "Render");
  const std::string path = asked["links"]["self"];
  {
    // One waits and hangs up,
    httplib::Client bystander("127.0.0.1", server->port());
    bystander.set_read_timeout(0, 200000);
    EXPECT_FALSE(bystander.Get(path + "?wait_s=30"));
  }
  // others delete, with what they can guess.
  httplib::Client stranger("127.0.0.1", server->port());
  for (const std::string query :
       {"", "?lease=", "?lease=researcher", "?lease=connection", "?lease=x"}) {
    const auto refused = stranger.Delete(path + query);
    EXPECT_EQ(error_of(refused, 403), "forbidden");
    EXPECT_EQ(field_of(refused), "lease");
  }
  {
    // One asks for the same picture and hangs up.
    httplib::Client hasty("127.0.0.1", server->port());
    hasty.set_read_timeout(0, 200000);
    EXPECT_FALSE(hasty.Get("/api/v1/image?scene=slow&technique=none"));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_EQ(body_of(client->Get(path), 200, "Render")["status"], "queued");
  renders->finish(asked["id"]);
  EXPECT_EQ(body_of(client->Get(path), 200, "Render")["status"], "done");
}

TEST_F(Renders, AreCancelledWhenTheOnlyClientHangsUp) {
  {
    httplib::Client hasty("127.0.0.1", server->port());
    hasty.set_read_timeout(0, 200000);
    EXPECT_FALSE(hasty.Get("/api/v1/image?scene=slow&technique=left"));
  }
  // The id of the same request, as the fake makes it.
  const json request = {{"scene", "slow"}, {"technique", "left"}};
  const auto id = sha256(request.dump()).substr(0, 32);
  for (int i = 0; i < 50 && renders->find(id)->status != "cancelled"; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(renders->find(id)->status, "cancelled");
}

TEST_F(Renders, AreAskedForInTheNameOfWhoCalls) {
  const json request = {{"scene", "slow"}, {"technique", "none"}};
  const auto id = body_of(post("/api/v1/renders", request), 202, "Render")["id"].get<std::string>();
  body_of(researcher->Post("/api/v1/renders", request.dump(), "application/json"), 202, "Render");
  const auto all = renders->submitters_of(id);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].priority, Priority::anonymous);
  EXPECT_EQ(all[0].client, "127.0.0.1");
  EXPECT_EQ(all[1].priority, Priority::researcher);
}

TEST_F(Renders, ThatCannotBeMadeAreToldOfByReadiness) {
  httplib::Client operations("127.0.0.1", server->ops_port());
  EXPECT_EQ(operations.Get("/readyz")->status, 200);
  renders->in_trouble = "no renderer is running, the last one failed: signal 11";
  const auto unready = operations.Get("/readyz");
  EXPECT_EQ(unready->status, 503);
  EXPECT_NE(unready->body.find("no renderer is running"), std::string::npos) << unready->body;
}

TEST_F(Renders, TellTheirProgressAsEvents) {
  const auto id = body_of(post("/api/v1/renders", {{"scene", "slow"}, {"technique", "none"}}), 202,
                          "Render")["id"]
                      .get<std::string>();
  std::thread worker([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    renders->finish(id);
  });
  const auto events = client->Get("/api/v1/renders/" + id + "/events");
  worker.join();
  ASSERT_TRUE(events);
  EXPECT_EQ(events->get_header_value("Content-Type"), "text/event-stream");
  std::vector<std::string> states;
  std::istringstream lines(events->body);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("data: ")) {
      const auto record = json::parse(line.substr(6));
      expect_schema(record, "Render");
      states.push_back(record["status"]);
    }
  EXPECT_EQ(states, (std::vector<std::string>{"queued", "done"}));
}

TEST_F(Renders, OfASweepAreCountedAndTabled) {
  const json sweep = {
      {"scenes", {"boxes", "broken"}}, {"techniques", {"none", "esm"}}, {"sizes", {64}}};
  const auto started =
      body_of(researcher->Post("/api/v1/sweeps", sweep.dump(), "application/json"), 202, "Sweep");
  const auto path = started["links"]["self"].get<std::string>();
  const auto events = researcher->Get(path + "/events");
  ASSERT_TRUE(events);
  const auto done = body_of(researcher->Get(path), 200, "Sweep");
  EXPECT_EQ(done["status"], "done");
  EXPECT_EQ(done["done"], 2);
  EXPECT_EQ(done["failed"], 2);
  const auto csv = researcher->Get(path + "/results.csv");
  ASSERT_TRUE(csv);
  EXPECT_EQ(std::count(csv->body.begin(), csv->body.end(), '\n'), 5);
  EXPECT_NE(csv->body.find("boxes,esm,64,done"), std::string::npos);
  const auto bad =
      researcher->Post("/api/v1/sweeps", R"({"scenes":[],"techniques":["a"]})", "application/json");
  EXPECT_EQ(error_of(bad, 400), "bad_value");
  EXPECT_EQ(field_of(bad), "scenes");
  restart();
  const auto after = researcher->Get(path + "/events");
  EXPECT_EQ(body_of(researcher->Get(path), 200, "Sweep")["total"], 4);
}

TEST_F(Renders, OfManySweepsAreForgottenAndFoundAgain) {
  std::vector<std::string> paths;
  for (int i = 0; i < 40; ++i) {
    const json sweep = {{"scenes", {"boxes"}}, {"techniques", {"none"}}, {"sizes", {64 + i}}};
    const auto started =
        body_of(researcher->Post("/api/v1/sweeps", sweep.dump(), "application/json"), 202, "Sweep");
    paths.push_back(started["links"]["self"]);
    researcher->Get(paths.back() + "/events");
  }
  httplib::Client operations("127.0.0.1", server->ops_port());
  const auto metrics = operations.Get("/metrics")->body;
  const std::string gauge = "\npenumbra_sweeps_kept ";
  const auto kept = metrics.find(gauge);
  ASSERT_NE(kept, std::string::npos) << metrics;
  EXPECT_LE(std::stoi(metrics.substr(kept + gauge.size())), 32);
  researcher->Get(paths.front() + "/events");
  const auto csv = researcher->Get(paths.front() + "/results.csv");
  EXPECT_NE(csv->body.find("boxes,none,64,done"), std::string::npos) << csv->body;
}

TEST_F(Renders, ListScenesAndTechniques) {
  const auto scenes = body_of(client->Get("/api/v1/scenes"), 200, "SceneList");
  EXPECT_FALSE(scenes["scenes"].empty());
  const auto techniques = body_of(client->Get("/api/v1/techniques"), 200, "TechniqueList");
  EXPECT_TRUE(techniques["techniques"].is_array());
}

}  // namespace
}  // namespace penumbra::server::http
