#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "renderer/error.h"
#include "server/storage/data_folder.h"
#include "server/storage/participants.h"
#include "server/storage/studies.h"
#include "tests/storage/folder.h"
#include "tests/storage/participation.h"

namespace penumbra::server::storage {

namespace fs = std::filesystem;
using nlohmann::json;

/// Everything that is open on a data folder.
struct Store {
  explicit Store(const fs::path& folder) : owned(folder), database(folder / "penumbra.sqlite") {}
  DataFolder owned;
  Database database;
  Studies studies{database};
  Participants participants{database};
};

class Damaged : public testing::Test {
 protected:
  Damaged() {
    make_private_folder(data);
    Store store(data);
    open_study(store.studies);
  }

  static ParticipantRecord enter(Store& store, const std::string& name) {
    return store.participants.enrol(person(name), 0, "2026-01-01");
  }

  static void answer(Store& store, const ParticipantRecord& who, int page, int value) {
    const auto id = who.pseudonym + "-" + std::to_string(page) + "-" + std::to_string(value);
    store.participants.answer(
        who, {page, id, {{"difficulty", value}}, "2026-01-03"}, [](const json&) { return true; },
        [](const std::string&, int) { return json::object(); });
  }

  void fill(int people, int pages) {
    Store store(data);
    for (int p = 0; p < people; ++p) {
      const auto who = enter(store, std::to_string(p));
      for (int page = 0; page < pages; ++page) answer(store, who, page, 1 + page % 5);
    }
  }

  /// What an export would hold.
  static std::string exported(Store& store) {
    std::string text;
    store.participants.each("s", 1, [&](const ParticipantData& person) {
      const auto& who = person.participant;
      text += who.pseudonym + " " + std::to_string(who.place) + " " + who.entered_at +
              (person.excluded() ? " excluded\n" : "\n");
      for (const auto& one : person.answers)
        text += std::to_string(one.page) + one.answer_id + one.body.dump() + one.answered_at + "\n";
    });
    return text;
  }

  /// Changes the database behind the program's back, in its only file.
  void change(const std::string& sql) {
    SQLite::Database other(file().string(), SQLite::OPEN_READWRITE);
    other.exec(sql);
    other.exec("PRAGMA wal_checkpoint(TRUNCATE)");
  }

  fs::path file() const { return data / "penumbra.sqlite"; }

  TemporaryFolder folder;
  fs::path data = folder.path / "data";
};

inline std::string code_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code;
  }
  return "";
}

}  // namespace penumbra::server::storage
