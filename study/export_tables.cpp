#include "study/export_tables.h"

#include <algorithm>

#include "figures/text.h"

namespace penumbra::study {

namespace {

std::string line_of(const std::vector<std::string>& cells) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) text += (i == 0 ? "" : ",") + csv_text(cells[i]);
  return text + "\r\n";
}

std::string line_of(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return line_of(names);
}

std::string truth(bool value) {
  return value ? "TRUE" : "FALSE";
}

std::string text_of(const nlohmann::json& object, const std::string& key) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return {};
  return found->is_string() ? found->get<std::string>() : found->dump();
}

const std::vector<Column>& pair_columns() {
  static const std::vector<Column> list{
      {"observer", "text", "pseudonym"},
      {"session", "integer", "1; second showings are left out"},
      {"scene", "text", "the page's id"},
      {"A", "text", "a picture's id"},
      {"B", "text", "another picture's id, behind A in alphabetical order"},
      {"selected", "integer", "1 where A was put before B, 0 where B was put before A"},
      {"tie", "boolean",
       "TRUE where both share a place: selected is then 1 and 0 in turn, so that sums count a tie "
       "half to each"}};
  return list;
}

const std::vector<Column>& participant_columns() {
  static const std::vector<Column> list{
      {"participant", "text", "pseudonym"},
      {"place", "integer", "in the balanced orders of pages and pictures, from 0"},
      {"arm", "text",
       "way of giving ranks that the participant was assigned to; empty where there is one only"},
      {"entered_at", "text", "ISO 8601, UTC"},
      {"last_seen_at", "text", "when the last answer was stored, ISO 8601, UTC"},
      {"completed_at", "text", "ISO 8601, UTC; empty where the participant stopped early"},
      {"completed", "boolean", "TRUE where all pages were answered and the study was finished"},
      {"outcome", "text",
       "completed; screened_out: a check ended the study; started: stopped early or still at it"},
      {"pages_answered", "integer", "practice and second showings included"},
      {"pages", "integer", "pages that the participant was given"},
      {"language", "text", "of the page"},
      {"consent_version", "text", "that was agreed to"},
      {"test", "boolean", "TRUE for a researcher's preview, which is counted nowhere"},
      {"excluded", "boolean", "TRUE where a researcher took the participant out"},
      {"exclusion_reason", "text", "as the researcher gave it"},
      {"flags", "text", "names of flags, separated by blanks"},
      {"entries", "integer", "how often the same name in the link entered the study"},
      {"practice_right", "boolean", "TRUE where the practice page was ordered as it is meant"},
      {"patches_seen", "integer", "dark patches of eight that were told apart on the screen"},
      {"comment", "text", "as it was typed at the end"}};
  return list;
}

template <typename Value>
std::string optional_text(const std::optional<Value>& value) {
  if (!value) return {};
  if constexpr (std::is_same_v<Value, bool>) return truth(*value);
  return std::to_string(*value);
}

}  // namespace

std::string PairsTable::header() {
  return line_of(pair_columns());
}

void PairsTable::append(const std::vector<ResponseRow>& page, std::string& text) {
  std::vector<const ResponseRow*> rows;
  for (const ResponseRow& row : page)
    if (row.repeat == 0 && row.included) rows.push_back(&row);
  std::sort(rows.begin(), rows.end(),
            [](const auto* a, const auto* b) { return a->technique < b->technique; });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string before = csv_text(rows[i]->participant) + ",1," + csv_text(rows[i]->scene) +
                               "," + csv_text(rows[i]->technique) + ",";
    for (std::size_t j = i + 1; j < rows.size(); ++j) {
      const bool tie = rows[i]->rank == rows[j]->rank;
      bool first = rows[i]->rank < rows[j]->rank;
      if (tie) {
        bool& turn = next_tie[{rows[i]->scene, rows[i]->technique, rows[j]->technique}];
        turn = !turn;
        first = turn;
      }
      text += before + csv_text(rows[j]->technique) + (first ? ",1," : ",0,") + truth(tie) + "\r\n";
    }
  }
}

WideTable::WideTable(const Study& study) {
  for (const Page& page : study.pages) {
    if (!page.counted()) continue;
    PageColumns columns{page.id, {}};
    for (const Picture& picture : page.pictures) columns.pictures.push_back(picture.id);
    pages.push_back(columns);
  }
  for (const std::size_t index : study.repeats) {
    const auto first = std::find_if(pages.begin(), pages.end(), [&](const PageColumns& page) {
      return page.id == study.pages.at(index).id;
    });
    PageColumns columns = *first;
    columns.id += ".again";
    pages.push_back(columns);
  }
}

std::vector<Column> WideTable::columns() const {
  std::vector<Column> list{
      {"participant", "text", "pseudonym"},
      {"included", "boolean", "FALSE where a researcher took the participant out"},
      {"completed", "boolean", "TRUE where the participant finished the study"},
      {"flags", "text", "names of flags, separated by blanks"}};
  for (const PageColumns& page : pages) {
    for (const auto& picture : page.pictures)
      list.push_back(
          {page.id + "." + picture, "number",
           "rank of the picture on the page, 1 is most realistic, mid-rank where equal"});
    list.push_back({page.id + ".difficulty", "integer", "1 hard to see, 5 easy"});
  }
  return list;
}

std::string WideTable::header() const {
  return line_of(columns());
}

void WideTable::append(const std::vector<std::vector<ResponseRow>>& answered,
                       std::string& text) const {
  if (answered.empty()) return;
  std::map<std::string, std::string> values;
  for (const auto& rows : answered) {
    for (const ResponseRow& row : rows) {
      const std::string page = row.scene + (row.repeat > 0 ? ".again" : "");
      values[page + "." + row.technique] = figures::number_text(row.rank, 1);
      if (row.difficulty) values[page + ".difficulty"] = std::to_string(*row.difficulty);
    }
  }
  const ResponseRow& first = answered.front().front();
  std::vector<std::string> cells{first.participant, truth(first.included),
                                 truth(first.page && first.page->participant_completed),
                                 first.flags};
  for (const PageColumns& page : pages) {
    for (const auto& picture : page.pictures) cells.push_back(values[page.id + "." + picture]);
    cells.push_back(values[page.id + ".difficulty"]);
  }
  text += line_of(cells);
}

ParticipantsTable::ParticipantsTable(const Study& study)
    : parameters(study.id_parameters), checked(checked_pages(study)) {
  for (const Demographic& question : study.demographics) questions.push_back(question.id);
}

std::vector<Column> ParticipantsTable::columns() const {
  std::vector<Column> list = participant_columns();
  for (const auto& name : parameters)
    list.push_back({"parameter." + name, "text", "parameter of the link the participant came by"});
  for (const auto& name : checked)
    list.push_back({"expected." + name, "boolean",
                    "TRUE where this page got the answer that an attentive person gives"});
  for (const auto& name : questions)
    list.push_back({"answer." + name, "text", "answer to the study's question about the person"});
  return list;
}

std::string ParticipantsTable::header() const {
  return line_of(columns());
}

void ParticipantsTable::append(const ParticipantRow& row, std::string& text) const {
  std::vector<std::string> cells{row.participant,
                                 std::to_string(row.place),
                                 row.arm,
                                 row.entered_at,
                                 row.seen_at,
                                 row.completed_at,
                                 truth(!row.completed_at.empty()),
                                 row.outcome,
                                 std::to_string(row.pages_answered),
                                 std::to_string(row.pages),
                                 row.language,
                                 row.consent_version,
                                 truth(row.test),
                                 truth(row.excluded),
                                 row.exclusion_reason,
                                 row.flags,
                                 std::to_string(row.checks.entries),
                                 optional_text(row.checks.practice_right),
                                 optional_text(row.checks.patches_seen),
                                 text_of(row.details, "comment")};
  for (const auto& name : parameters) cells.push_back(text_of(row.parameters, name));
  for (const auto& name : checked) {
    const auto& pages = row.checks.pages;
    const auto page = std::find_if(pages.begin(), pages.end(),
                                   [&](const CheckedPage& one) { return one.page == name; });
    cells.push_back(page == pages.end() ? "" : truth(page->met));
  }
  const auto answers = row.details.value("demographics", nlohmann::json::object());
  for (const auto& name : questions) cells.push_back(text_of(answers, name));
  text += line_of(cells);
}

const std::vector<std::pair<std::string, std::string>>& export_documents() {
  static const std::vector<std::pair<std::string, std::string>> list{
      {"report.html", "the results in words, with figures; opens by itself and prints"},
      {"results.json", "all statistics, with methods, versions and warnings"},
      {"results.tex", "tables for LaTeX (booktabs)"},
      {"tables.txt", "means in the columns of their subsets, as van Sambeek 2007 prints them"},
      {"study.json", "the study as it was published"},
      {"responses.json", "participants with their pages, answers as sent and earlier answers"},
      {"recompute.R", "recomputes the headline numbers from responses.csv in R"},
      {"recompute.py", "recomputes the headline numbers from responses.csv with pandas"},
      {"figures/*.svg", "figures for print, 85 or 178 mm wide"}};
  return list;
}

std::string write_codebook(const Study& study) {
  std::string text = line_of(std::vector<std::string>{"file", "column", "type", "meaning"});
  const auto add = [&](const std::string& file, const std::vector<Column>& columns) {
    for (const Column& column : columns)
      text += line_of({file, column.name, column.type, column.meaning});
  };
  add("responses.csv", response_columns());
  add("earlier_responses.csv", response_columns());
  add("responses_wide.csv", WideTable(study).columns());
  add("pairs.csv", pair_columns());
  add("participants.csv", ParticipantsTable(study).columns());
  add("codebook.csv", {{"file", "text", "a file of this archive"},
                       {"column", "text", "empty for files that are no tables"},
                       {"type", "text", "text, number, integer, boolean or document"},
                       {"meaning", "text", "what the column or file holds"}});
  for (const auto& [file, meaning] : export_documents())
    text += line_of({file, "", "document", meaning});
  return text;
}

}  // namespace penumbra::study
