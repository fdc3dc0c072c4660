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

/// The tables of an archive, while they are written side by side.
struct StudyExport::Tables {
  struct Table {
    TemporaryFile file;
    PieceWriter writer;

    Table(const fs::path& work, const std::string& extension)
        : file(work, extension), writer(file.path()) {}
  };
  Table responses, earlier, wide, pairs, people, documents;

  explicit Tables(const fs::path& work)
      : responses(work, ".csv"),
        earlier(work, ".csv"),
        wide(work, ".csv"),
        pairs(work, ".csv"),
        people(work, ".csv"),
        documents(work, ".json") {}
};

/// Goes through everybody once.
void StudyExport::write_tables(Tables& tables) {
  study::PairsTable pairs_table;
  const study::WideTable wide_table(frozen->study);
  const study::ParticipantsTable people_table(frozen->study);
  const auto entries = participants.entries_by_person(frozen->study.id);
  auto &responses = tables.responses.writer, &earlier = tables.earlier.writer;
  auto& documents = tables.documents.writer;
  responses.add(study::response_header());
  earlier.add(study::response_header());
  tables.wide.writer.add(wide_table.header());
  tables.pairs.writer.add(study::PairsTable::header());
  tables.people.writer.add(people_table.header());
  documents.add("{\"study\": " + json(frozen->study.id).dump() +
                ", \"study_hash\": " + json(frozen->hash).dump() + ", \"participants\": [");
  bool first = true;
  each(true, [&](const Person& person) {
    const auto& who = person.data.participant;
    people_table.append(
        participant_row(*frozen, person.data, checks_of(*frozen, person.data, entries),
                        names_of_flags(who.pseudonym)),
        tables.people.writer.text());
    if (who.test) return;
    documents.add((first ? "\n" : ",\n") + person.document);
    first = false;
    for (const auto& page : person.pages) {
      for (const auto& row : page) study::append_response(row, responses.text());
      pairs_table.append(page, tables.pairs.writer.text());
    }
    wide_table.append(person.pages, tables.wide.writer.text());
    for (const auto& page : pages_of(*frozen, person.data, person.data.replaced))
      for (const auto& row : page) study::append_response(row, earlier.text());
  });
  documents.add("\n]}\n");
  for (auto* table : {&tables.responses, &tables.earlier, &tables.wide, &tables.pairs,
                      &tables.people, &tables.documents})
    table->writer.finish();
}

void StudyExport::write_archive(const fs::path& archive, const fs::path& work,
                                const std::vector<storage::Damage>& damage) {
  results();
  find_flags();
  Tables tables(work);
  write_tables(tables);

  const auto context = report_context();
  ZipWriter zip(archive);
  zip.add_text("report.html", study::html_report(report, context));
  zip.add_text("results.json", scenes::json_text(report, 2) + "\n");
  zip.add_text("results.tex", study::latex_tables(report, options.labels));
  zip.add_text("tables.txt", study::statistics_table(report, options));
  zip.add_file("responses.csv", tables.responses.file.path());
  zip.add_file("earlier_responses.csv", tables.earlier.file.path());
  zip.add_file("responses_wide.csv", tables.wide.file.path());
  zip.add_file("pairs.csv", tables.pairs.file.path());
  zip.add_file("participants.csv", tables.people.file.path());
  zip.add_text("codebook.csv", study::write_codebook(frozen->study));
  zip.add_file("responses.json", tables.documents.file.path());
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

}  // namespace penumbra::server::http
