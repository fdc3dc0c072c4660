#pragma once

#include <gtest/gtest.h>

#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/faults/server_process.h"
#include "tests/storage/folder.h"

namespace penumbra::faults {

using nlohmann::json;

/// A small study: two pages of three pictures.
json small_study(const std::string& id = "small");
inline const std::string study_at = "/api/v1/studies/small";

/// Stores and opens the study; waits for its pictures.
void publish(const ServerProcess& server, const json& study = small_study());

/// Copies a data folder in which the small study is open. Its pictures are drawn once.
void copy_published(const std::filesystem::path& data);

std::string random_uuid();

/// A render that takes many seconds on any machine, fast GPUs too, 1000 pixels high.
json slow_render(int width);

/// Somebody who takes part.
struct Person {
  std::string token;
  std::string withdrawal_code;
  json pages;

  std::string at() const { return "/api/v1/participants/" + token; }
  std::string page(std::size_t index) const { return at() + "/pages/" + std::to_string(index); }
  /// An answer to a page: its pictures in the order of their slots, turned by `turn`.
  json answer(std::size_t index, const std::string& id, int turn = 0) const;
};

/// Empty token where it was refused.
Person enter(httplib::Client& client, const std::string& study = study_at);

/// What was acknowledged: by person and page, the answer's id and the reply.
class Acknowledged {
 public:
  void add(const Person& person, std::size_t page, const std::string& answer,
           const std::string& reply);
  std::size_t size() const;
  /// Answers that the server does not show any more.
  int lost(const ServerProcess& server) const;
  /// Pages with more rows in responses.csv than pictures.
  static int doubled(const ServerProcess& server);

 private:
  struct Answer {
    std::string person;
    std::size_t page;
    std::string id;
  };
  mutable std::mutex mutex;
  std::vector<Answer> answers;
};

/// A test with a folder, in which a study is open.
class WithStudy : public testing::Test {
 protected:
  void SetUp() override { copy_published(data); }
  ServerOptions options(std::vector<std::string> arguments = {}) const {
    ServerOptions all;
    all.data = data;
    all.arguments = std::move(arguments);
    return all;
  }

  server::TemporaryFolder folder;
  std::filesystem::path data = folder.path / "data";
};

}  // namespace penumbra::faults
