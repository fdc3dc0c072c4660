#include "server/storage/participants.h"

#include "renderer/error.h"
#include "server/files/digest.h"
#include "server/storage/participant_rows.h"

namespace penumbra::server::storage {
namespace {

/// study::next_place, found in indexes: the first place that is no longer held, or a new one.
/// Looking at every place would make a study's enrolments cost the square of their number.
std::size_t next_place(SQLite::Database& connection, const ParticipantRecord& fresh,
                       const std::string& abandoned_before) {
  SQLite::Statement query(
      connection,
      "SELECT MIN(place) FROM ("
      "SELECT place FROM participants WHERE study = ?1 AND version = ?2 AND test = 0 AND "
      "holds_place = 1 AND completed_at IS NULL AND seen_at < ?3 "
      "UNION ALL "
      "SELECT w.place FROM withdrawals AS w WHERE w.study = ?1 AND w.version = ?2 AND "
      "w.place IS NOT NULL AND NOT EXISTS (SELECT 1 FROM participants AS p WHERE p.study = ?1 AND "
      "p.version = ?2 AND p.place = w.place AND p.holds_place = 1 AND p.test = 0) "
      "UNION ALL "
      "SELECT COALESCE((SELECT place + 1 FROM participants WHERE study = ?1 AND version = ?2 "
      "AND holds_place = 1 AND test = 0 ORDER BY place DESC LIMIT 1), 0))");
  query.bind(1, fresh.study);
  query.bind(2, fresh.version);
  query.bind(3, abandoned_before);
  query.executeStep();
  return static_cast<std::size_t>(query.getColumn(0).getInt64());
}

bool quota_reached(SQLite::Database& connection, const std::string& study, int version,
                   std::uint32_t quota) {
  if (quota == 0) return false;
  SQLite::Statement completed(connection,
                              "SELECT COUNT(*) FROM participants WHERE study = ? AND version = ? "
                              "AND test = 0 AND completed_at IS NOT NULL");
  completed.bind(1, study);
  completed.bind(2, version);
  completed.executeStep();
  return completed.getColumn(0).getInt64() >= quota;
}

void check_enrolment(SQLite::Database& connection, const ParticipantRecord& fresh,
                     std::uint32_t quota, bool once) {
  SQLite::Statement status(connection,
                           "SELECT status FROM studies WHERE study = ? AND version = ?");
  status.bind(1, fresh.study);
  status.bind(2, fresh.version);
  const bool there = status.executeStep();
  if (there && fresh.test) return;
  if (!there || status.getColumn(0).getString() != "open")
    throw Error("conflict", "the study is not open", "study");
  if (quota_reached(connection, fresh.study, fresh.version, quota))
    throw Error("conflict", "the study has as many participants as it needs", "quota");
  if (!once || fresh.person_id.empty()) return;
  SQLite::Statement same(connection,
                         "SELECT 1 FROM participants WHERE study = ? AND person_id = ? AND "
                         "test = 0 LIMIT 1");
  same.bind(1, fresh.study);
  same.bind(2, fresh.person_id);
  if (same.executeStep())
    throw Error("conflict",
                "somebody has entered with this link already; open it in the browser in which you "
                "began",
                "parameters");
}

/// Place of the new person, taken over from the one who left it.
std::size_t take_place(SQLite::Database& connection, const ParticipantRecord& fresh,
                       const std::string& abandoned_before) {
  if (fresh.test) {
    SQLite::Statement tests(connection,
                            "SELECT COUNT(*) FROM participants WHERE study = ? AND version = ? "
                            "AND test = 1");
    tests.bind(1, fresh.study);
    tests.bind(2, fresh.version);
    tests.executeStep();
    return static_cast<std::size_t>(tests.getColumn(0).getInt64());
  }
  const auto place = next_place(connection, fresh, abandoned_before);
  SQLite::Statement release(connection,
                            "UPDATE participants SET holds_place = 0 WHERE study = ? AND "
                            "version = ? AND place = ? AND test = 0 AND holds_place = 1");
  release.bind(1, fresh.study);
  release.bind(2, fresh.version);
  release.bind(3, static_cast<std::int64_t>(place));
  release.exec();
  return place;
}

/// The current answers of a participant, or those that were replaced.
std::vector<AnswerRecord> answers_of(Database& database, Connection& connection,
                                     std::int64_t participant, bool current) {
  auto query = connection.query(
      std::string("SELECT page, answer_id, body, answered_at, intact, row FROM checked_answers "
                  "WHERE participant = ? AND is_current = ") +
      (current ? "1" : "0") + " ORDER BY page, row");
  query->bind(1, participant);
  std::vector<AnswerRecord> found;
  while (query->executeStep()) {
    if (query->getColumn(4).getInt() == 0) {
      report_row(database, connection, "answers", query->getColumn(5).getInt64());
      continue;
    }
    found.push_back({query->getColumn(0).getInt(), query->getColumn(1).getString(),
                     nlohmann::json::parse(query->getColumn(2).getString()),
                     query->getColumn(3).getString()});
  }
  return found;
}

std::vector<Exclusion> exclusions_of(Database& database, Connection& connection,
                                     std::int64_t participant) {
  auto query = connection.query(
      "SELECT excluded, reason, decided_at, intact, row FROM checked_exclusions "
      "WHERE participant = ? ORDER BY id");
  query->bind(1, participant);
  std::vector<Exclusion> found;
  while (query->executeStep()) {
    if (query->getColumn(3).getInt() == 0) {
      report_row(database, connection, "exclusions", query->getColumn(4).getInt64());
      continue;
    }
    found.push_back({query->getColumn(0).getInt() != 0, query->getColumn(1).getString(),
                     query->getColumn(2).getString()});
  }
  return found;
}

/// Throws where the person may not answer any more.
void check_answerable(Connection& connection, const ParticipantRecord& participant,
                      const std::string& closed_before) {
  auto query = connection.query(
      "SELECT p.completed_at IS NOT NULL, s.status = 'closed' AND s.closed_at < ?2 "
      "FROM participants AS p JOIN studies AS s ON s.study = p.study AND s.version = p.version "
      "WHERE p.id = ?1");
  query->bind(1, participant.key);
  query->bind(2, closed_before);
  if (!query->executeStep()) throw not_found("participant", "there is nothing at this address");
  if (query->getColumn(0).getInt() != 0)
    throw Error("conflict", "the study was completed already", "participant");
  if (query->getColumn(1).getInt() != 0) throw Error("conflict", "the study is closed", "study");
}

/// Takes the mark from the page's current answer and returns its id, empty where there is none.
std::string retire_current(Connection& connection, std::int64_t participant, int page) {
  auto query = connection.query(
      "SELECT answer_id FROM answers WHERE participant = ? AND page = ? AND "
      "is_current = 1");
  query->bind(1, participant);
  query->bind(2, page);
  const std::string replaced = query->executeStep() ? query->getColumn(0).getString() : "";
  auto retire = connection.query(
      "UPDATE answers SET is_current = 0 WHERE participant = ? AND page = ? "
      "AND is_current = 1");
  retire->bind(1, participant);
  retire->bind(2, page);
  retire->exec();
  return replaced;
}

int pages_answered(Connection& connection, std::int64_t participant) {
  auto query =
      connection.query("SELECT COUNT(*) FROM answers WHERE participant = ? AND is_current = 1");
  query->bind(1, participant);
  query->executeStep();
  return query->getColumn(0).getInt();
}

}  // namespace

ParticipantRecord Participants::enrol(const ParticipantRecord& fresh, std::uint32_t quota,
                                      const std::string& abandoned_before, bool once) {
  return database.write([&](Connection& connection) {
    if (const auto known = find_where(database, connection, "study = ? AND enrolment_id = ?",
                                      fresh.study, fresh.enrolment_id))
      return *known;
    check_enrolment(connection, fresh, quota, once);
    ParticipantRecord record = fresh;
    record.place = take_place(connection, fresh, abandoned_before);
    SQLite::Statement insert(
        connection,
        "INSERT INTO participants (pseudonym, study, version, place, holds_place, test, token, "
        "token_hash, withdrawal_code, enrolment_id, language, consent_version, parameters, "
        "details, entered_at, seen_at, person_id) VALUES (?, ?, ?, ?, 1, ?, ?, ?, ?, ?, ?, ?, ?, "
        "'{}', ?, ?, NULLIF(?, ''))");
    int next = 1;
    insert.bind(next++, record.pseudonym);
    insert.bind(next++, record.study);
    insert.bind(next++, record.version);
    insert.bind(next++, static_cast<std::int64_t>(record.place));
    insert.bind(next++, record.test ? 1 : 0);
    insert.bind(next++, record.token);
    insert.bind(next++, sha256(record.token));
    insert.bind(next++, record.withdrawal_code);
    insert.bind(next++, record.enrolment_id);
    insert.bind(next++, record.language);
    insert.bind(next++, record.consent_version);
    insert.bind(next++, record.parameters.dump());
    insert.bind(next++, record.entered_at);
    insert.bind(next++, record.entered_at);
    insert.bind(next++, record.person_id);
    insert.exec();
    record.key = connection.getLastInsertRowid();
    return record;
  });
}

std::optional<ParticipantRecord> Participants::find(const std::string& token) {
  return database.read([&](Connection& connection) {
    return find_where(database, connection, "token_hash = ?", sha256(token));
  });
}

std::vector<AnswerRecord> Participants::answers(std::int64_t participant) {
  return database.read(
      [&](Connection& connection) { return answers_of(database, connection, participant, true); });
}

nlohmann::json Participants::answer(
    const ParticipantRecord& participant, const AnswerRecord& fresh,
    const std::function<bool(const nlohmann::json&)>& same,
    const std::function<nlohmann::json(const std::string&, int)>& make_reply,
    const std::string& closed_before) {
  return database.write([&](Connection& connection) {
    auto known = connection.query(
        "SELECT page, body, reply, intact FROM checked_answers "
        "WHERE participant = ? AND answer_id = ?");
    known->bind(1, participant.key);
    known->bind(2, fresh.answer_id);
    if (known->executeStep()) {
      if (known->getColumn(3).getInt() == 0) throw damaged_row();
      const bool repeated = known->getColumn(0).getInt() == fresh.page &&
                            same(nlohmann::json::parse(known->getColumn(1).getString()));
      if (!repeated)
        throw Error("conflict", "another answer was stored under this id", "answer_id");
      return nlohmann::json::parse(known->getColumn(2).getString());
    }
    check_answerable(connection, participant, closed_before);
    const auto replaced = retire_current(connection, participant.key, fresh.page);
    const auto reply = make_reply(replaced, pages_answered(connection, participant.key) + 1);
    auto insert = connection.query(
        "INSERT INTO answers (participant, page, answer_id, body, reply, "
        "answered_at, is_current) VALUES (?, ?, ?, ?, ?, ?, 1)");
    insert->bind(1, participant.key);
    insert->bind(2, fresh.page);
    insert->bind(3, fresh.answer_id);
    insert->bind(4, fresh.body.dump());
    insert->bind(5, reply.dump());
    insert->bind(6, fresh.answered_at);
    insert->exec();
    auto seen = connection.query("UPDATE participants SET seen_at = ? WHERE id = ?");
    seen->bind(1, fresh.answered_at);
    seen->bind(2, participant.key);
    seen->exec();
    return reply;
  });
}

void Participants::complete(const ParticipantRecord& participant, int pages,
                            const nlohmann::json& details, const std::string& now) {
  database.write([&](Connection& connection) {
    SQLite::Statement state(connection,
                            "SELECT completed_at IS NOT NULL FROM participants WHERE id = ?");
    state.bind(1, participant.key);
    if (!state.executeStep()) throw not_found("participant", "there is nothing at this address");
    if (state.getColumn(0).getInt() != 0) return;
    const int answered = pages_answered(connection, participant.key);
    if (answered < pages)
      throw Error("conflict",
                  std::to_string(pages - answered) + " of " + std::to_string(pages) +
                      " pages have no answer yet",
                  "pages");
    SQLite::Statement update(
        connection,
        "UPDATE participants SET completed_at = ?, seen_at = ?, details = ? WHERE id = ?");
    update.bind(1, now);
    update.bind(2, now);
    auto all = participant.details;
    all.update(details);
    update.bind(3, all.dump());
    update.bind(4, participant.key);
    update.exec();
  });
}

ParticipantRecord Participants::note_details(const ParticipantRecord& participant,
                                             const nlohmann::json& details) {
  return database.write([&](Connection& connection) {
    auto record = find_where(database, connection, "token_hash = ?", sha256(participant.token));
    if (!record) throw not_found("participant", "there is nothing at this address");
    if (!record->completed_at.empty()) return *record;
    record->details.update(details);
    SQLite::Statement update(connection, "UPDATE participants SET details = ? WHERE id = ?");
    update.bind(1, record->details.dump());
    update.bind(2, record->key);
    update.exec();
    return *record;
  });
}

bool Participants::withdraw(const std::string& code, const std::string& now) {
  return database.write([&](Connection& connection) {
    const auto person = find_where(database, connection, "withdrawal_code = ?", code);
    if (!person) return false;
    SQLite::Statement remove(connection, "DELETE FROM participants WHERE id = ?");
    remove.bind(1, person->key);
    remove.exec();
    database.purge_log();
    if (person->test) return true;
    SQLite::Statement note(
        connection,
        "INSERT INTO withdrawals (study, version, withdrawn_at, place) VALUES (?, ?, ?, ?)");
    note.bind(1, person->study);
    note.bind(2, person->version);
    note.bind(3, now);
    note.bind(4, static_cast<std::int64_t>(person->place));
    note.exec();
    return true;
  });
}

bool Participants::exclude(const std::string& study, const std::string& pseudonym,
                           const Exclusion& decision) {
  return database.write([&](Connection& connection) {
    const auto person =
        find_where(database, connection, "study = ? AND pseudonym = ?", study, pseudonym);
    if (!person) return false;
    SQLite::Statement insert(connection,
                             "INSERT INTO exclusions (participant, excluded, reason, decided_at) "
                             "VALUES (?, ?, ?, ?)");
    insert.bind(1, person->key);
    insert.bind(2, decision.excluded ? 1 : 0);
    insert.bind(3, decision.reason);
    insert.bind(4, decision.decided_at);
    insert.exec();
    return true;
  });
}

std::vector<ParticipantData> Participants::portion(const std::string& study, int version,
                                                   std::optional<std::int64_t>& after) {
  constexpr int most = 100;
  int seen = 0;
  auto people = database.read([&](Connection& connection) {
    SQLite::Statement query(connection,
                            std::string("SELECT ") + participant_columns +
                                " FROM checked_participants WHERE study = ? AND version = ? "
                                "AND id > ? ORDER BY id LIMIT ?");
    query.bind(1, study);
    query.bind(2, version);
    query.bind(3, after.value());
    query.bind(4, most);
    std::vector<ParticipantData> found;
    while (query.executeStep()) {
      ++seen;
      after = query.getColumn(0).getInt64();
      if (const auto record = participant_of_row(database, query))
        found.push_back({*record, {}, {}, {}});
    }
    for (auto& person : found) {
      person.answers = answers_of(database, connection, person.participant.key, true);
      person.replaced = answers_of(database, connection, person.participant.key, false);
      person.exclusions = exclusions_of(database, connection, person.participant.key);
    }
    return found;
  });
  if (seen < most) after.reset();
  return people;
}

void Participants::each(const std::string& study, int version,
                        const std::function<void(const ParticipantData&)>& take) {
  each(
      study, version, [](ParticipantData&& person) { return std::move(person); }, take);
}

bool Participants::is_full(const std::string& study, int version, std::uint32_t quota) {
  return database.read(
      [&](Connection& connection) { return quota_reached(connection, study, version, quota); });
}

}  // namespace penumbra::server::storage
