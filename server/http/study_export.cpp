#include "server/http/study_export.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <set>

#include "renderer/error.h"
#include "scenes/json_text.h"
#include "server/http/archive.h"
#include "server/http/person_state.h"
#include "server/http/piece_writer.h"
#include "study/export_tables.h"
#include "study/report/latex.h"
#include "study/report/scripts.h"
#include "study/statistics/report.h"
#include "study/statistics/survey_data.h"

namespace penumbra::server::http {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Rows of one person by page, in the order of the pages: of the answers that count, or of those
/// that were replaced.
Pages pages_of(const FrozenStudy& frozen, const storage::ParticipantData& person,
               const std::vector<storage::AnswerRecord>& answers) {
  std::map<int, int> before;
  const bool current = &answers == &person.answers;
  if (current)
    for (const auto& earlier : person.replaced) ++before[earlier.page];
  Pages pages;
  const auto plan = frozen.plan(person.participant.place);
  const auto& arm = study::arm_of(frozen.study, plan);
  for (const auto& stored : answers) {
    const auto& planned = plan.pages.at(static_cast<std::size_t>(stored.page));
    const int answers_before = current ? before[stored.page] : before[stored.page]++;
    if (planned.kind == study::PageKind::practice ||
        !study::page_of(frozen.study, planned).counted())
      continue;
    const auto answer = study::parse_answer(stored.body, arm, planned.slots.size());
    pages.push_back(study::response_rows(frozen.study, frozen.hash, person.participant.pseudonym,
                                         arm, planned, stored.page, answer, stored.answered_at));
    auto facts = std::make_shared<study::PageFacts>();
    facts->seen = answer.observations;
    facts->participant_completed = !person.participant.completed_at.empty();
    facts->answers_before = answers_before;
    for (auto& row : pages.back()) {
      row.included = !person.excluded();
      row.started_at = person.participant.entered_at;
      row.page = facts;
    }
  }
  return pages;
}

json answer_json(const storage::AnswerRecord& answer) {
  return {{"answered_at", answer.answered_at}, {"body", answer.body}};
}

/// A person as responses.json has it.
json person_json(const FrozenStudy& frozen, const storage::ParticipantData& person) {
  const auto& who = person.participant;
  const auto plan = frozen.plan(who.place);
  json pages = json::array();
  for (const auto& stored : person.answers) {
    const auto& planned = plan.pages.at(static_cast<std::size_t>(stored.page));
    const auto& page = study::page_of(frozen.study, planned);
    json pictures = json::array();
    for (const std::size_t number : planned.slots) pictures.push_back(page.pictures.at(number).id);
    json earlier = json::array();
    for (const auto& replaced : person.replaced)
      if (replaced.page == stored.page) earlier.push_back(answer_json(replaced));
    pages.push_back({{"page_index", stored.page},
                     {"kind", study::kind_name(planned.kind)},
                     {"page", page.id},
                     {"scene", page.scene},
                     {"pictures_by_slot", pictures},
                     {"answer", answer_json(stored)},
                     {"earlier_answers", earlier}});
  }
  json decisions = json::array();
  for (const auto& decision : person.exclusions)
    decisions.push_back({{"excluded", decision.excluded},
                         {"reason", decision.reason},
                         {"at", decision.decided_at}});
  return {{"participant", who.pseudonym},
          {"arm", study::arm_of(frozen.study, plan).id},
          {"entered_at", who.entered_at},
          {"completed_at", who.completed_at.empty() ? json(nullptr) : json(who.completed_at)},
          {"language", who.language},
          {"consent_version", who.consent_version},
          {"parameters", who.parameters},
          {"details", who.details},
          {"decisions", decisions},
          {"pages", pages}};
}

study::ParticipantRow participant_row(const FrozenStudy& frozen,
                                      const storage::ParticipantData& person,
                                      const study::PersonChecks& checks, const std::string& flags) {
  const auto& who = person.participant;
  const auto outcome = outcome_of(frozen, who, person.answers);
  const auto plan = frozen.plan(who.place);
  return {who.pseudonym,
          who.place,
          study::arm_of(frozen.study, plan).id,
          who.entered_at,
          who.seen_at,
          who.completed_at,
          outcome.empty() ? "started" : outcome,
          person.answers.size(),
          plan.pages.size(),
          who.language,
          who.consent_version,
          who.test,
          person.excluded(),
          person.excluded() ? person.exclusions.back().reason : "",
          flags,
          checks,
          who.parameters,
          who.details};
}

/// Names of flags, each once, separated by blanks.
std::string flag_names(const json& flags) {
  std::string list;
  for (const auto& flag : flags) {
    const auto name = flag.at("flag").get<std::string>();
    if ((" " + list + " ").find(" " + name + " ") == std::string::npos)
      list += (list.empty() ? "" : " ") + name;
  }
  return list;
}

std::string damaged_csv(const std::vector<storage::Damage>& damage) {
  std::string text = "participant,table,row,damage\r\n";
  for (const auto& one : damage)
    text += study::csv_text(one.participant) + "," + study::csv_text(one.table) + "," +
            std::to_string(one.row) + "," + study::csv_text(one.what) + "\r\n";
  return text;
}

}  // namespace

TemporaryFile::TemporaryFile(const fs::path& folder, const std::string& extension) {
  static std::atomic<unsigned> count{0};
  fs::create_directories(folder);
  file = folder / (std::to_string(::getpid()) + "-" + std::to_string(count++) + extension);
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  fs::remove(file, ignored);
}

StudyExport::StudyExport(storage::Participants& participants_,
                         std::shared_ptr<const FrozenStudy> frozen_, std::size_t withdrawn,
                         study::Measures measures_)
    : participants(participants_),
      frozen(std::move(frozen_)),
      measures(std::move(measures_)),
      options(study::report_options(frozen->study)) {
  attendance.withdrawn = withdrawn;
  options.measures = measures;
}

/// Reads everybody's answers once.
void StudyExport::gather() {
  if (data) return;
  study::statistics::Gatherer gatherer;
  const auto entries = participants.entries_by_person(frozen->study.id);
  participants.each(frozen->study.id, frozen->version, [&](const storage::ParticipantData& person) {
    if (person.participant.test) return;
    ++attendance.entered;
    attendance.completed += person.participant.completed_at.empty() ? 0 : 1;
    if (person.excluded())
      attendance.excluded.push_back(
          {person.participant.pseudonym, person.exclusions.back().reason});
    for (auto& flag : study::check_flags(frozen->study, person.participant.pseudonym,
                                         checks_of(*frozen, person, entries)))
      options.given_flags.push_back(std::move(flag));
    const auto pages = pages_of(*frozen, person, person.answers);
    evidence[person.participant.pseudonym] = evidence_of(pages);
    for (const auto& page : pages)
      for (const auto& row : page) gatherer.add(row);
  });
  data = gatherer.finish();
}

void StudyExport::find_flags() {
  if (found_flags) return;
  gather();
  std::set<std::string> told;
  for (auto& flag : study::survey_flags(*data, options)) {
    add_evidence(flag);
    const auto name = flag.at("participant").get<std::string>();
    flags.try_emplace(name, json::array()).first->second.push_back(flag);
    told.insert(name + " " + flag.at("flag").get<std::string>());
  }
  for (const auto& flag : flags_of_excluded())
    if (told.insert(flag.at("participant").get<std::string>() + " " +
                    flag.at("flag").get<std::string>())
            .second)
      flags.try_emplace(flag.at("participant"), json::array()).first->second.push_back(flag);
  found_flags = true;
}

StudyExport::InversionEvidence StudyExport::evidence_of(const Pages& pages) {
  InversionEvidence found;
  for (const auto& page : pages) {
    ++found.pages;
    const auto by_rank = [](const auto& a, const auto& b) { return a.rank < b.rank; };
    const auto [best, worst] = std::minmax_element(page.begin(), page.end(), by_rank);
    const auto truth = std::find_if(page.begin(), page.end(),
                                    [](const auto& row) { return row.technique == "reference"; });
    found.reference_last +=
        truth != page.end() && truth->rank == worst->rank && best->rank < worst->rank ? 1 : 0;
    found.turned_round += page.front().swapped_direction.value_or(false) ? 1 : 0;
  }
  return found;
}

/// Says beside a flag of inversion what else speaks for it.
void StudyExport::add_evidence(json& flag) const {
  const auto name = flag.at("flag").get<std::string>();
  if (name != "inverted" && name != "page_inverted") return;
  const auto& found = evidence.at(flag.at("participant").get<std::string>());
  flag["evidence"] = {{"pages", found.pages},
                      {"reference_last", found.reference_last},
                      {"turned_round", found.turned_round}};
}

/// Statistics leave people aside who were taken out; their flags are the reasons for that and stay.
/// The given flags are of people without counted pages as well.
json StudyExport::flags_of_excluded() {
  auto list = json::array();
  std::set<std::string> excluded;
  for (const auto& one : attendance.excluded) excluded.insert(one.participant);
  if (!excluded.empty()) {
    study::statistics::Gatherer everybody;
    participants.each(frozen->study.id, frozen->version,
                      [&](const storage::ParticipantData& person) {
                        if (person.participant.test) return;
                        for (auto& page : pages_of(*frozen, person, person.answers))
                          for (auto& row : page) {
                            row.included = true;
                            everybody.add(row);
                          }
                      });
    for (const auto& flag :
         study::screening_flags(everybody.finish(), frozen->study.analysis.screening))
      if (excluded.contains(flag.at("participant").get<std::string>())) {
        list.push_back(flag);
        add_evidence(list.back());
      }
  }
  for (const auto& flag : options.given_flags) list.push_back(study::flag_json(flag));
  return list;
}

const std::map<std::string, json>& StudyExport::flags_by_participant() {
  find_flags();
  return flags;
}

const json& StudyExport::results() {
  if (!report.is_null()) return report;
  gather();
  report = study::survey_report(*data, options);
  for (auto& flag : report.at("flags")) add_evidence(flag);
  return report;
}

study::ReportContext StudyExport::report_context() {
  gather();
  auto figures = study::figure_options(frozen->study);
  figures.measures = measures;
  return {&frozen->study, attendance, figures};
}

std::string StudyExport::names_of_flags(const std::string& pseudonym) const {
  const auto found = flags.find(pseudonym);
  return found == flags.end() ? "" : flag_names(found->second);
}

void StudyExport::each(bool documents, const std::function<void(const Person&)>& take) {
  const auto make = [&](storage::ParticipantData&& stored) {
    Person person{std::move(stored), {}, {}};
    if (documents && !person.data.participant.test)
      person.document = scenes::json_text(person_json(*frozen, person.data));
    return person;
  };
  const auto add_pages = [&](Person& person) {
    if (!person.data.participant.test)
      person.pages = pages_of(*frozen, person.data, person.data.answers);
    const auto names = names_of_flags(person.data.participant.pseudonym);
    for (auto& page : person.pages)
      for (auto& row : page) row.flags = names;
    take(person);
    person = {};  // a portion's rows are many times its answers
  };
  participants.each(frozen->study.id, frozen->version, make, add_pages);
}

void StudyExport::write_responses(const fs::path& file) {
  find_flags();
  PieceWriter responses(file);
  responses.add(study::response_header());
  each(false, [&](const Person& person) {
    for (const auto& page : person.pages)
      for (const auto& row : page) study::append_response(row, responses.text());
  });
  responses.finish();
}

void StudyExport::write_archive(const fs::path& archive, const fs::path& work,
                                const std::vector<storage::Damage>& damage) {
  results();
  find_flags();
  const TemporaryFile responses_file(work, ".csv");
  const TemporaryFile earlier_file(work, ".csv");
  const TemporaryFile wide_file(work, ".csv");
  const TemporaryFile pairs_file(work, ".csv");
  const TemporaryFile participants_file(work, ".csv");
  const TemporaryFile json_file(work, ".json");
  PieceWriter responses(responses_file.path());
  PieceWriter earlier(earlier_file.path());
  PieceWriter wide(wide_file.path());
  PieceWriter pairs(pairs_file.path());
  PieceWriter people(participants_file.path());
  PieceWriter documents(json_file.path());

  // Write the tables side by side, a person at a time.
  study::PairsTable pairs_table;
  const study::WideTable wide_table(frozen->study);
  const study::ParticipantsTable people_table(frozen->study);
  const auto entries = participants.entries_by_person(frozen->study.id);
  responses.add(study::response_header());
  earlier.add(study::response_header());
  wide.add(wide_table.header());
  pairs.add(study::PairsTable::header());
  people.add(people_table.header());
  documents.add("{\"study\": " + json(frozen->study.id).dump() +
                ", \"study_hash\": " + json(frozen->hash).dump() + ", \"participants\": [");
  bool first = true;
  each(true, [&](const Person& person) {
    const auto& who = person.data.participant;
    people_table.append(
        participant_row(*frozen, person.data, checks_of(*frozen, person.data, entries),
                        names_of_flags(who.pseudonym)),
        people.text());
    if (who.test) return;
    documents.add((first ? "\n" : ",\n") + person.document);
    first = false;
    for (const auto& page : person.pages) {
      for (const auto& row : page) study::append_response(row, responses.text());
      pairs_table.append(page, pairs.text());
    }
    wide_table.append(person.pages, wide.text());
    for (const auto& page : pages_of(*frozen, person.data, person.data.replaced))
      for (const auto& row : page) study::append_response(row, earlier.text());
  });
  documents.add("\n]}\n");
  for (PieceWriter* writer : {&responses, &earlier, &wide, &pairs, &people, &documents})
    writer->finish();

  // Put everything into the archive.
  const auto context = report_context();
  ZipWriter zip(archive);
  zip.add_text("report.html", study::html_report(report, context));
  zip.add_text("results.json", scenes::json_text(report, 2) + "\n");
  zip.add_text("results.tex", study::latex_tables(report, options.labels));
  zip.add_text("tables.txt", study::statistics_table(report, options));
  zip.add_file("responses.csv", responses_file.path());
  zip.add_file("earlier_responses.csv", earlier_file.path());
  zip.add_file("responses_wide.csv", wide_file.path());
  zip.add_file("pairs.csv", pairs_file.path());
  zip.add_file("participants.csv", participants_file.path());
  zip.add_text("codebook.csv", study::write_codebook(frozen->study));
  zip.add_file("responses.json", json_file.path());
  if (!damage.empty()) zip.add_text("damaged.csv", damaged_csv(damage));
  zip.add_text("study.json", scenes::json_text(frozen->study.document, 2) + "\n");
  for (const auto& file : study::report_files()) {
    const fs::path name = fs::path(file.path).filename();
    if (name.extension() != ".css") zip.add_text(name.string(), std::string(file.text));
  }
  for (const auto& figure : study::figures_of(report, context.figures))
    zip.add_text("figures/" + figure.name + ".svg", figure.svg);
  zip.finish();
}

study::PersonChecks checks_of(const FrozenStudy& frozen, const storage::ParticipantData& person,
                              const std::map<std::string, int>& entries) {
  auto checks = checks_of(frozen, person.participant, person.answers);
  const auto found = entries.find(person.participant.person_id);
  if (found != entries.end()) checks.entries = found->second;
  return checks;
}

}  // namespace penumbra::server::http
