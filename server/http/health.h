#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "server/http/frozen_pictures.h"
#include "server/storage/data_folder.h"
#include "server/storage/database.h"

namespace penumbra::server::http {

/// Whether the server can keep what it is sent: it writes to the database and to the disk, and
/// reads the pictures of open studies. Thread-safe.
class Health {
 public:
  Health(const storage::DataFolder& folder_, storage::Database& database_,
         FrozenPictures& pictures_)
      : folder(folder_), database(database_), pictures(pictures_) {}

  /// Empty, or the first thing that is wrong, in words that name no path. Tries things at most
  /// every two seconds and returns the last finding in between.
  std::string trouble();

 private:
  std::string look();

  const storage::DataFolder& folder;
  storage::Database& database;
  FrozenPictures& pictures;
  std::mutex mutex;
  std::chrono::steady_clock::time_point next{};
  std::string last;
};

}  // namespace penumbra::server::http
