#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "server/storage/database.h"
#include "study/enrolment.h"

namespace penumbra::server::storage {

struct ParticipantRecord {
  std::int64_t key = 0;
  std::string pseudonym;  ///< the only name in exports
  std::string study;
  int version = 1;
  std::size_t place = 0;  ///< in the balanced orders of the version
  bool test = false;      ///< a researcher's preview, never counted
  std::string token;
  std::string withdrawal_code;
  std::string enrolment_id;
  std::string language;
  std::string consent_version;
  nlohmann::json parameters = nlohmann::json::object();  ///< of the link
  std::string person_id;  ///< of the link; empty where the study asks for none
  nlohmann::json details = nlohmann::json::object();  ///< about the person, given at the end
  std::string entered_at;
  std::string completed_at;  ///< empty until completed
  std::string seen_at;       ///< last answer, or entry
};

struct AnswerRecord {
  int page = 0;
  std::string answer_id;
  nlohmann::json body;
  std::string answered_at;
};

struct Exclusion {
  bool excluded = false;
  std::string reason;
  std::string decided_at;
};

/// A participant with everything that exports need.
struct ParticipantData {
  ParticipantRecord participant;
  std::vector<AnswerRecord> answers;   ///< current ones, by page
  std::vector<AnswerRecord> replaced;  ///< earlier ones, by page, oldest first
  std::vector<Exclusion> exclusions;   ///< in order; the last one counts

  bool excluded() const { return !exclusions.empty() && exclusions.back().excluded; }
};

/// People and their answers.
class Participants {
 public:
  explicit Participants(Database& database_) : database(database_) {}

  /// Enrols a person; `fresh` brings everything but key and place. The same enrolment_id in the
  /// same study again returns the person stored first. The place is study::next_place; a place is
  /// given away when its holder has not completed and was not seen since `abandoned_before`.
  /// Throws `conflict` where the version is not open (tests may enter drafts as well), `quota`
  /// people (0: no limit) have completed, or with `once` the person_id has entered any version.
  ParticipantRecord enrol(const ParticipantRecord& fresh, std::uint32_t quota,
                          const std::string& abandoned_before, bool once = false);

  std::optional<ParticipantRecord> find(const std::string& token);

  /// Current answers, by page.
  std::vector<AnswerRecord> answers(std::int64_t participant);

  /// Stores an answer and returns the reply that is stored with it. The same answer_id again gets
  /// the reply stored first if `same(stored body)` says that the content is equal, otherwise
  /// `conflict`. A new answer_id replaces the page's current answer, which stays as history. Throws
  /// `conflict` after completion and where the version was closed before `closed_before`: people
  /// who were amid it have a while to finish. `make_reply` gets the answer_id of the answer
  /// replaced (empty: none) and the number of pages answered now.
  nlohmann::json answer(const ParticipantRecord& participant, const AnswerRecord& fresh,
                        const std::function<bool(const nlohmann::json&)>& same,
                        const std::function<nlohmann::json(const std::string&, int)>& make_reply,
                        const std::string& closed_before = {});

  /// Marks as completed once all `pages` have an answer (otherwise `conflict`), with details about
  /// the person added to those noted before. Repeating changes nothing.
  void complete(const ParticipantRecord& participant, int pages, const nlohmann::json& details,
                const std::string& now);

  /// Adds to what is known about a person who has not completed; returns the person as stored now.
  ParticipantRecord note_details(const ParticipantRecord& participant,
                                 const nlohmann::json& details);

  /// Deletes the person who holds the code, with all answers; false where there is none.
  bool withdraw(const std::string& code, const std::string& now);

  /// Records a decision. False where the study has no such person.
  bool exclude(const std::string& study, const std::string& pseudonym, const Exclusion& decision);

  /// Calls `take` for every participant of a version in order of entry, in portions, so that a long
  /// export holds no snapshot for long and the write-ahead log stays bounded.
  void each(const std::string& study, int version,
            const std::function<void(const ParticipantData&)>& take);

  /// The same with what `make` makes of a ParticipantData. It runs in another thread, while `take`
  /// takes what was made of the portion before.
  template <class Make, class Take>
  void each(const std::string& study, int version, const Make& make, const Take& take) {
    std::optional<std::int64_t> after = 0;
    const auto next_portion = [&] {
      std::vector<std::invoke_result_t<Make, ParticipantData&&>> made;
      for (auto& person : portion(study, version, after)) made.push_back(make(std::move(person)));
      return made;
    };
    auto made = next_portion();
    while (after) {
      auto next = std::async(std::launch::async, next_portion);
      for (auto& one : made) take(one);
      made = next.get();
    }
    for (auto& one : made) take(one);
  }

  /// Answers of completed and started people (no tests) per page position is of no use, since
  /// positions differ; so per participant: place and positions answered.
  struct Progress {
    std::size_t place = 0;
    std::vector<int> pages;
  };
  std::vector<Progress> progress(const std::string& study, int version);

  /// Whether `quota` people (0: no limit) have completed the version.
  bool is_full(const std::string& study, int version, std::uint32_t quota);

  /// How often each person_id entered a study, in all its versions; those that did so once are left
  /// out.
  std::map<std::string, int> entries_by_person(const std::string& study);

 private:
  /// The next people whose keys lie beyond `after`, which is moved on; no value after the last.
  std::vector<ParticipantData> portion(const std::string& study, int version,
                                       std::optional<std::int64_t>& after);

  Database& database;
};

}  // namespace penumbra::server::storage
