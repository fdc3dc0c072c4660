#pragma once

#include <gtest/gtest.h>
#include <httplib.h>

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "server/http/serve.h"
#include "tests/http/fake_renders.h"
#include "tests/http/schema.h"
#include "tests/storage/folder.h"

namespace penumbra::server::http {

using nlohmann::json;

/// A server on ports of its own, with a fake in place of the renderer, and clients for it.
class RunningServer : public testing::Test {
 protected:
  void SetUp() override { start(); }

  void start() {
    options.port = 0;
    options.ops_port = 0;
    options.data = folder.path / "data";
    options.worker_command = {PENUMBRA_BINARY_DIR "/penumbra", "worker"};
    adjust(options);
    server = std::make_unique<Server>(options, [this] {
      auto fake = std::make_unique<FakeRenders>();
      renders = fake.get();
      return fake;
    });
    server->start();
    client = std::make_unique<httplib::Client>("127.0.0.1", server->port());
    client->set_keep_alive(true);
    client->set_read_timeout(20);
    researcher = std::make_unique<httplib::Client>("127.0.0.1", server->port());
    researcher->set_keep_alive(true);
    researcher->set_read_timeout(20);
    researcher->set_bearer_token_auth(server->token());
  }

  /// Options of a test's own.
  virtual void adjust(ServeOptions&) {}

  void stop() {
    client.reset();
    researcher.reset();
    server->stop(1.0);
    server.reset();
  }

  void restart() {
    stop();
    start();
  }

  httplib::Result post(const std::string& path, const json& body) {
    return client->Post(path, body.dump(), "application/json");
  }

  /// Body of an answer, checked against its state and schema of schema/openapi.yaml.
  static json body_of(const httplib::Result& result, int status, const std::string& schema) {
    EXPECT_TRUE(result) << httplib::to_string(result.error());
    if (!result) return nullptr;
    EXPECT_EQ(result->status, status) << result->body;
    const auto body = json::parse(result->body, nullptr, false);
    EXPECT_FALSE(body.is_discarded()) << result->body;
    expect_schema(body, schema);
    return body;
  }

  /// Code of a failure, checked like every other body.
  static std::string error_of(const httplib::Result& result, int status) {
    const auto body = body_of(result, status, "Error");
    return body.is_object() && body.contains("error") ? body["error"]["code"].get<std::string>()
                                                      : "";
  }

  static std::string field_of(const httplib::Result& result) {
    return json::parse(result->body).at("error").at("field").get<std::string>();
  }

  /// Draft studies are published, with the fake's pictures, before anybody may enter.
  std::string publish(const std::string& study) {
    const auto path = "/api/v1/studies/" + study;
    researcher->Post(path + "/publish", "", "application/json");
    std::string status;
    for (int i = 0; i < 400 && status != "open"; ++i) {
      status = json::parse(researcher->Get(path)->body).value("status", "");
      if (status != "open") std::this_thread::sleep_for(std::chrono::milliseconds(25));
    }
    return status;
  }

  /// The experiment once it is over, or as it is after a minute and a half.
  json experiment_over(const std::string& id) {
    json state;
    for (int i = 0; i < 900; ++i) {
      state = body_of(researcher->Get("/api/v1/experiments/" + id), 200, "Experiment");
      if (state["status"] != "queued" && state["status"] != "running") break;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return state;
  }

  TemporaryFolder folder;
  ServeOptions options;  ///< of the next start
  FakeRenders* renders = nullptr;
  std::unique_ptr<Server> server;
  std::unique_ptr<httplib::Client> client;
  std::unique_ptr<httplib::Client> researcher;
};

}  // namespace penumbra::server::http
