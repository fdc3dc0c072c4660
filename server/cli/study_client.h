#pragma once

#include <httplib.h>

#include <nlohmann/json.hpp>
#include <string>

#include "study/simulate.h"
#include "study/study.h"

namespace penumbra::server::cli {

/// A running server's API as a researcher calls it. Failures are the server's own Errors.
class StudyClient {
 public:
  /// `url` as the server printed it, `/lab?token=...` included or not. The token in it goes before
  /// `token`.
  StudyClient(const std::string& url, const std::string& token);

  nlohmann::json call(const std::string& method, const std::string& path,
                      const nlohmann::json& body = nlohmann::json::object());

  /// Stores and publishes the study where the server does not have it open, and waits until it is.
  /// Returns it as the API has it.
  nlohmann::json open(const study::Study& study);

  /// One person enters, answers every page and completes. `body` is the open study's.
  void take_part(const study::Study& study, const nlohmann::json& body,
                 const study::SimulatedPerson& person, const study::Preferences& preferences);

 private:
  httplib::Client client;
};

}  // namespace penumbra::server::cli
