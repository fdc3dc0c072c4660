#pragma once

#include <chrono>
#include <string>
#include <thread>

#include "tests/http/running_server.h"

namespace penumbra::server::http {

/// The study that ships, opened, and people in it.
class AStudy : public RunningServer {
 protected:
  const std::string id = "thesis-2007";
  const std::string at = "/api/v1/studies/thesis-2007";

  json study() { return body_of(researcher->Get(at), 200, "Study"); }

  json wait_until(const std::string& study_path, const std::string& status) {
    json body;
    for (int i = 0; i < 3000; ++i) {
      body = body_of(researcher->Get(study_path), 200, "Study");
      if (body["status"] == status) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_EQ(body["status"], status);
    return body;
  }

  json publish() {
    const auto result = researcher->Post(at + "/publish", "", "application/json");
    EXPECT_TRUE(result->status == 202 || result->status == 200) << result->body;
    return wait_until(at, "open");
  }

  json results_of_all() {
    return body_of(researcher->Get(at + "/results.json"), 200, "Results")["included_sets"]["all"];
  }

  json enter(const json& body = json::object()) {
    return body_of(post(at + "/participants", body), 201, "Enrolment");
  }

  static std::string uuid(int number) {
    const auto digits = std::to_string(number);
    return "00000000-0000-4000-8000-" + std::string(12 - digits.size(), '0') + digits;
  }

  /// An answer that puts the pictures in the order of their slots.
  static json answer(const json& page, int number, int difficulty = 3) {
    json shelves;
    for (const auto& image : page["images"])
      shelves[std::to_string(image["slot"].get<int>())] = image["slot"];
    return {{"answer_id", uuid(number)},
            {"shelves", shelves},
            {"difficulty", difficulty},
            {"active_ms", 60000},
            {"total_ms", 61000}};
  }

  static std::string page_of(const json& person, std::size_t page) {
    return "/api/v1/participants/" + person["participant"].get<std::string>() + "/pages/" +
           std::to_string(page);
  }

  httplib::Result put(const std::string& path, const json& body) {
    return client->Put(path, body.dump(), "application/json");
  }

  void answer_all(const json& person, int first_number) {
    for (std::size_t page = 0; page < person["pages"].size(); ++page)
      body_of(put(page_of(person, page),
                  answer(person["pages"][page], first_number + static_cast<int>(page))),
              200, "AnswerReply");
  }

  httplib::Result complete(const json& person) {
    return client->Post(
        "/api/v1/participants/" + person["participant"].get<std::string>() + "/complete", "{}",
        "application/json");
  }
};

}  // namespace penumbra::server::http
