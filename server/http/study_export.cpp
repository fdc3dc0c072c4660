#include "server/http/study_export.h"

#include <unistd.h>

#include <atomic>
#include <fstream>

#include "renderer/error.h"
#include "scenes/json_text.h"
#include "server/http/archive.h"
#include "study/export_tables.h"
#include "study/report/latex.h"
#include "study/report/scripts.h"
#include "study/statistics/report.h"
#include "study/statistics/survey_data.h"

namespace penumbra::server::http {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A file that is written in large pieces.
class PieceWriter {
 public:
  explicit PieceWriter(const fs::path& file) : path(file), stream(file, std::ios::binary) {}

  void add(const std::string& text) {
    buffer += text;
    if (buffer.size() > piece) flush();
  }
  std::string& text() {
    if (buffer.size() > piece) flush();
    return buffer;
  }
  void finish() {
    flush();
    stream.close();
    if (!stream) throw Error("storage", "cannot write " + path.filename().string());
  }

 private:
  static constexpr std::size_t piece = 1 << 20;

  void flush() {
    stream.write(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    buffer.clear();
  }

  fs::path path;
  std::ofstream stream;
  std::string buffer;
};

/// Rows of one person by page, in the order of the pages.
std::vector<std::vector<study::ResponseRow>> pages_of(const FrozenStudy& frozen,
                                                      const storage::ParticipantData& person) {
  std::map<int, int> replaced;
  for (const auto& earlier : person.replaced) ++replaced[earlier.page];
  std::vector<std::vector<study::ResponseRow>> pages;
  const auto plan = frozen.plan(person.participant.place);
  for (const auto& stored : person.answers) {
    const auto& planned = plan.pages.at(static_cast<std::size_t>(stored.page));
    if (planned.kind == study::PageKind::practice) continue;
    const auto answer = study::parse_answer(stored.body, frozen.study, planned.slots.size());
    pages.push_back(study::response_rows(frozen.study, frozen.hash, person.participant.pseudonym,
                                         planned, stored.page, answer, stored.answered_at));
    auto facts = std::make_shared<study::PageFacts>();
    facts->seen = answer.observations;
    facts->participant_completed = !person.participant.completed_at.empty();
    facts->answers_before = replaced[stored.page];
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
    for (const std::size_t picture : planned.slots)
      pictures.push_back(page.pictures.at(picture).id);
    json earlier = json::array();
    for (const auto& replaced : person.replaced)
      if (replaced.page == stored.page) earlier.push_back(answer_json(replaced));
    const char* kind = planned.kind == study::PageKind::practice ? "practice"
                       : planned.kind == study::PageKind::repeat ? "repeat"
                                                                 : "ranking";
    pages.push_back({{"page_index", stored.page},
                     {"kind", kind},
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
                                      const std::string& flags) {
  const auto& who = person.participant;
  return {who.pseudonym,
          who.entered_at,
          who.completed_at,
          person.answers.size(),
          frozen.plan(who.place).pages.size(),
          who.language,
          who.consent_version,
          who.test,
          person.excluded(),
          person.excluded() ? person.exclusions.back().reason : "",
          flags,
          who.parameters,
          who.details};
}

/// Leaves out what statistics do not look at: it is most of a row's memory.
void slim(study::ResponseRow& row) {
  row.study = row.study_hash = row.preset = row.parameters_hash = {};
  row.started_at = row.answered_at = {};
  row.page.reset();
}

std::map<std::string, std::string> flag_names(const json& flags) {
  std::map<std::string, std::string> names;
  for (const auto& flag : flags) {
    auto& list = names[flag.at("participant").get<std::string>()];
    const auto name = flag.at("flag").get<std::string>();
    if ((" " + list + " ").find(" " + name + " ") == std::string::npos)
      list += (list.empty() ? "" : " ") + name;
  }
  return names;
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
                         std::shared_ptr<const FrozenStudy> frozen_, std::size_t withdrawn)
    : participants(participants_), frozen(std::move(frozen_)) {
  attendance.withdrawn = withdrawn;
}

void StudyExport::analyse() {
  if (!report.is_null()) return;
  study::statistics::Gatherer gatherer;
  participants.each(frozen->study.id, frozen->version, [&](const storage::ParticipantData& person) {
    if (person.participant.test) return;
    ++attendance.entered;
    attendance.completed += person.participant.completed_at.empty() ? 0 : 1;
    if (person.excluded())
      attendance.excluded.push_back(
          {person.participant.pseudonym, person.exclusions.back().reason});
    for (const auto& page : pages_of(*frozen, person))
      for (const auto& row : page) gatherer.add(row);
  });
  report = study::survey_report(gatherer.finish(), study::report_options(frozen->study));
  flags = flag_names(report.at("flags"));
}

const json& StudyExport::results() {
  analyse();
  return report;
}

study::ReportContext StudyExport::report_context() {
  analyse();
  return {&frozen->study, attendance, study::figure_options(frozen->study)};
}

void StudyExport::each(const TakePerson& take) {
  participants.each(frozen->study.id, frozen->version, [&](const storage::ParticipantData& person) {
    auto pages = person.participant.test ? std::vector<std::vector<study::ResponseRow>>{}
                                         : pages_of(*frozen, person);
    for (auto& page : pages)
      for (auto& row : page) row.flags = flags[row.participant];
    take(person, pages);
  });
}

void StudyExport::write_responses(const fs::path& file) {
  analyse();
  PieceWriter responses(file);
  responses.add(study::response_header());
  each([&](const auto&, const auto& pages) {
    for (const auto& page : pages)
      for (const auto& row : page) study::append_response(row, responses.text());
  });
  responses.finish();
}

void StudyExport::write_archive(const fs::path& archive, const fs::path& work,
                                const std::vector<storage::Damage>& damage) {
  analyse();
  const TemporaryFile responses_file(work, ".csv");
  const TemporaryFile wide_file(work, ".csv");
  const TemporaryFile pairs_file(work, ".csv");
  const TemporaryFile participants_file(work, ".csv");
  const TemporaryFile json_file(work, ".json");
  PieceWriter responses(responses_file.path());
  PieceWriter wide(wide_file.path());
  PieceWriter pairs(pairs_file.path());
  PieceWriter people(participants_file.path());
  PieceWriter documents(json_file.path());

  // Write the tables side by side, a person at a time.
  study::PairsTable pairs_table;
  const study::WideTable wide_table(frozen->study);
  const study::ParticipantsTable people_table(frozen->study);
  responses.add(study::response_header());
  wide.add(wide_table.header());
  pairs.add(study::PairsTable::header());
  people.add(people_table.header());
  documents.add("{\"study\": " + json(frozen->study.id).dump() +
                ", \"study_hash\": " + json(frozen->hash).dump() + ", \"participants\": [");
  bool first = true;
  each([&](const storage::ParticipantData& person, const auto& pages) {
    people_table.append(participant_row(*frozen, person, flags[person.participant.pseudonym]),
                        people.text());
    if (person.participant.test) return;
    documents.add((first ? "\n" : ",\n") + scenes::json_text(person_json(*frozen, person)));
    first = false;
    std::vector<study::ResponseRow> all;
    for (const auto& page : pages) {
      for (const auto& row : page) study::append_response(row, responses.text());
      pairs_table.append(page, pairs.text());
      all.insert(all.end(), page.begin(), page.end());
    }
    wide_table.append(all, wide.text());
  });
  documents.add("\n]}\n");
  for (PieceWriter* writer : {&responses, &wide, &pairs, &people, &documents}) writer->finish();

  // Put everything into the archive.
  const auto options = study::report_options(frozen->study);
  const auto context = report_context();
  ZipWriter zip(archive);
  zip.add_text("report.html", study::html_report(report, context));
  zip.add_text("results.json", scenes::json_text(report, 2) + "\n");
  zip.add_text("results.tex", study::latex_tables(report, options.labels));
  zip.add_text("tables.txt", study::statistics_table(report, options));
  zip.add_file("responses.csv", responses_file.path());
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

std::vector<study::ResponseRow> rows_of(storage::Participants& participants,
                                        const FrozenStudy& frozen) {
  std::vector<study::ResponseRow> rows;
  participants.each(frozen.study.id, frozen.version, [&](const storage::ParticipantData& person) {
    if (person.participant.test) return;
    for (auto& page : pages_of(frozen, person))
      for (auto& row : page) {
        slim(row);
        rows.push_back(std::move(row));
      }
  });
  return rows;
}

}  // namespace penumbra::server::http
