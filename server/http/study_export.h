#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "server/http/frozen_study.h"
#include "server/http/person_rows.h"
#include "server/storage/participants.h"
#include "study/checks.h"
#include "study/measures.h"
#include "study/report/html.h"
#include "study/responses.h"
#include "study/statistics/report.h"
#include "study/statistics/survey_data.h"

/// What leaves a study. Everything is written from the data base in portions of people, so that a
/// study of any size leaves in bounded memory; none of it needs a running server.
namespace penumbra::server::http {

/// A file with a name of its own, in a folder; removed with the object.
class TemporaryFile {
 public:
  TemporaryFile(const std::filesystem::path& folder, const std::string& extension);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return file; }

 private:
  std::filesystem::path file;
};

/// One published version of a study with its answers.
class StudyExport {
 public:
  /// `withdrawn` people deleted their answers; `measures` are of the pictures shown.
  StudyExport(storage::Participants& participants, std::shared_ptr<const FrozenStudy> frozen,
              std::size_t withdrawn = 0, study::Measures measures = {});

  /// The statistics; computed when first asked for.
  const nlohmann::json& results();
  /// Flags by pseudonym, also of people who were taken out.
  const std::map<std::string, nlohmann::json>& flags_by_participant();
  study::ReportContext report_context();

  /// responses.csv, attention items, practice pages and previews left out.
  void write_responses(const std::filesystem::path& file);

  /// export.zip, with parts in `work`, a folder on the same disk, while it is made. What is left
  /// out since it is damaged is told in damaged.csv.
  void write_archive(const std::filesystem::path& archive, const std::filesystem::path& work,
                     const std::vector<storage::Damage>& damage = {});

 private:
  /// A person with the rows of the answers that count, by page; none of a test.
  struct Person {
    storage::ParticipantData data;
    Pages pages;
    std::string document;  ///< of responses.json, where it is wanted
  };

  struct Tables;

  void gather();
  void write_tables(Tables& tables);
  void find_flags();
  /// Calls `take` for everybody, with documents where `documents`.
  void each(bool documents, const std::function<void(const Person&)>& take);
  std::string names_of_flags(const std::string& pseudonym) const;
  void add_evidence(nlohmann::json& flag) const;
  nlohmann::json flags_of_excluded();

  storage::Participants& participants;
  std::shared_ptr<const FrozenStudy> frozen;
  study::Measures measures;
  std::optional<study::statistics::SurveyData> data;  ///< once gathered
  study::ReportOptions options;
  nlohmann::json report;
  std::map<std::string, nlohmann::json> flags;  ///< lists by pseudonym
  bool found_flags = false;
  /// What speaks for or against a scale that was read backwards, beside the flag itself.
  struct InversionEvidence {
    int pages = 0;
    int reference_last = 0;  ///< pages on which the true picture has the worst place
    int turned_round = 0;    ///< pages on which the order was turned round before it was sent
  };
  static InversionEvidence evidence_of(const Pages& pages);

  std::map<std::string, InversionEvidence> evidence;  ///< by pseudonym
  study::Attendance attendance;
};

}  // namespace penumbra::server::http
