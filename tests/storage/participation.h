#pragma once

#include <gtest/gtest.h>

#include <string>

#include "server/storage/participants.h"
#include "server/storage/studies.h"
#include "tests/storage/folder.h"

namespace penumbra::server::storage {

/// Publishes the study "s", which has no pages of its own.
inline void open_study(Studies& studies) {
  studies.put_draft("s", {{"id", "s"}}, 42, "2026-01-01");
  studies.start_publishing("s", 1, "hash", 0);
  studies.open("s", 1, "2026-01-01");
}

/// Somebody who is to enter it.
inline ParticipantRecord person(const std::string& name,
                                const std::string& entered = "2026-01-02") {
  ParticipantRecord record;
  record.pseudonym = "p-" + name;
  record.study = "s";
  record.token = "token-" + name;
  record.withdrawal_code = "code-" + name;
  record.enrolment_id = "enrolment-" + name;
  record.language = "en";
  record.entered_at = entered;
  return record;
}

/// An open study without pages of its own, and people who take part in it.
class Participation : public testing::Test {
 protected:
  Participation() { open_study(studies); }

  ParticipantRecord enter(const std::string& name, const std::string& entered = "2026-01-02") {
    return participants.enrol(person(name, entered), 0, "2026-01-01");
  }

  nlohmann::json answer(const ParticipantRecord& who, int page, const std::string& id,
                        const nlohmann::json& body) {
    return participants.answer(
        who, {page, id, body, "2026-01-03"},
        [&](const nlohmann::json& stored) { return stored == body; },
        [&](const std::string& replaced, int answered) {
          return nlohmann::json{{"id", id}, {"replaced", replaced}, {"answered", answered}};
        },
        "2026-01-05");
  }

  std::int64_t count(const std::string& query) {
    return database.read(
        [&](SQLite::Database& connection) { return connection.execAndGet(query).getInt64(); });
  }

  TemporaryFolder folder;
  Database database{folder.path / "db"};
  Studies studies{database};
  Participants participants{database};
};

}  // namespace penumbra::server::storage
