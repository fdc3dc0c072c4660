#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/storage/database.h"

namespace penumbra::server::storage {

/// Requests of sweeps by id.
class SweepRequests {
 public:
  explicit SweepRequests(Database& database_) : database(database_) {}
  void put(const std::string& id, const nlohmann::json& request, const std::string& now);
  std::optional<nlohmann::json> find(const std::string& id);

 private:
  Database& database;
};

}  // namespace penumbra::server::storage
