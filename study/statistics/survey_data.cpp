#include "study/statistics/survey_data.h"

#include <map>
#include <set>
#include <tuple>

namespace penumbra::study::statistics {

namespace {

std::vector<std::string> sorted(const std::set<std::string>& names) {
  return {names.begin(), names.end()};
}

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::lower_bound(names.begin(), names.end(), name) -
                                  names.begin());
}

PageAnswer page_answer(const std::vector<const ResponseRow*>& rows, const SurveyData& data) {
  const ResponseRow& first = *rows.front();
  PageAnswer page;
  page.participant = index_of(data.participants, first.participant);
  page.scene = index_of(data.scenes, first.scene);
  page.page_index = first.page_index;
  page.repeat = first.repeat;
  page.pictures = rows.size();
  page.doubled_ranks.assign(data.techniques.size(), missing);
  page.digits = page.doubled_ranks;
  page.slots = page.doubled_ranks;
  std::vector<double> ranks;
  for (const ResponseRow* row : rows) ranks.push_back(row->rank);
  const auto doubled = doubled_ranks(ranks);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t technique = index_of(data.techniques, rows[i]->technique);
    page.doubled_ranks[technique] = static_cast<double>(doubled[i]);
    if (rows[i]->digit) page.digits[technique] = *rows[i]->digit;
    if (rows[i]->slot) page.slots[technique] = *rows[i]->slot;
    if (!page.weight) {
      if (rows[i]->weight)
        page.weight = *rows[i]->weight;
      else if (rows[i]->difficulty)
        page.weight = *rows[i]->difficulty;
    }
    if (!page.active_ms) page.active_ms = rows[i]->active_ms;
  }
  return page;
}

/// Sums over a participant's pages for one technique.
struct Cell {
  std::int64_t doubled_ranks = 0;
  std::int64_t count = 0;
  double weighted = 0.0;
  double weight = 0.0;
  double digits = 0.0;
  bool all_digits = true;
};

using Cells = std::map<std::size_t, std::map<std::size_t, Cell>>;  // participant -> technique

void add_page(const PageAnswer& page, bool turned, bool any_weight, Cells& cells) {
  auto& row = cells[page.participant];
  for (std::size_t i = 0; i < page.doubled_ranks.size(); ++i) {
    if (is_missing(page.doubled_ranks[i])) continue;
    auto rank = static_cast<std::int64_t>(page.doubled_ranks[i]);
    if (turned) rank = 2 * (static_cast<std::int64_t>(page.pictures) + 1) - rank;
    Cell& cell = row[i];
    cell.doubled_ranks += rank;
    ++cell.count;
    const double weight = any_weight ? page.weight.value_or(0.0) : 1.0;
    cell.weighted += weight * 0.5 * static_cast<double>(rank);
    cell.weight += weight;
    cell.all_digits = cell.all_digits && !is_missing(page.digits[i]);
    cell.digits += turned ? 10.0 - page.digits[i] : page.digits[i];
  }
}

/// Smallest number that every cell's count divides, so that scaled means are integers. Beyond the
/// bound, which takes many unequal counts, means are exact to about 1e-9 instead.
std::int64_t common_count(const Cells& cells) {
  constexpr std::int64_t bound = 1'000'000'000;
  std::int64_t common = 1;
  for (const auto& [participant, row] : cells) {
    for (const auto& [technique, cell] : row) {
      const std::int64_t next = std::lcm(common, cell.count);
      if (next > bound) return bound;
      common = next;
    }
  }
  return common;
}

void fill_row(const std::map<std::size_t, Cell>& row, std::int64_t common,
              ParticipantTable& table) {
  const std::vector<double> blank(table.techniques.size(), missing);
  table.scaled_ranks.push_back(blank);
  table.weighted_ranks.push_back(blank);
  table.weights.emplace_back(table.techniques.size(), 0.0);
  table.digits.push_back(blank);
  for (std::size_t i = 0; i < table.techniques.size(); ++i) {
    const auto found = row.find(table.techniques[i]);
    if (found == row.end()) continue;
    const Cell& cell = found->second;
    const auto count = static_cast<double>(cell.count);
    table.scaled_ranks.back()[i] =
        std::round(static_cast<double>(cell.doubled_ranks) * (static_cast<double>(common) / count));
    table.weights.back()[i] = cell.weight;
    if (cell.weight > 0.0) table.weighted_ranks.back()[i] = cell.weighted / cell.weight;
    if (cell.all_digits) table.digits.back()[i] = cell.digits / count;
  }
}

}  // namespace

SurveyData gather(const std::vector<ResponseRow>& rows) {
  std::set<std::string> taken_out;
  for (const ResponseRow& row : rows) {
    if (!row.included) taken_out.insert(row.participant);
  }
  using Key = std::tuple<std::string, std::string, int, int>;
  std::map<Key, std::vector<const ResponseRow*>> groups;
  std::set<std::string> participants;
  std::set<std::string> scenes;
  std::set<std::string> techniques;
  for (const ResponseRow& row : rows) {
    if (taken_out.contains(row.participant)) continue;
    groups[{row.participant, row.scene, row.page_index, row.repeat}].push_back(&row);
    participants.insert(row.participant);
    scenes.insert(row.scene);
    techniques.insert(row.technique);
  }
  SurveyData data{sorted(participants), sorted(scenes), sorted(techniques), {}, sorted(taken_out)};
  for (const auto& [key, group] : groups) data.pages.push_back(page_answer(group, data));
  return data;
}

ParticipantTable participant_table(const SurveyData& data, const Selection& selection,
                                   std::optional<std::size_t> scene) {
  ParticipantTable table;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < data.pages.size(); ++i) {
    const PageAnswer& page = data.pages[i];
    if (!selection.used[i] || page.repeat > 0 || (scene && page.scene != *scene)) continue;
    chosen.push_back(i);
    table.any_weight = table.any_weight || page.weight.has_value();
  }
  table.pages = chosen.size();
  Cells cells;
  for (const std::size_t i : chosen) {
    add_page(data.pages[i], selection.turned[i], table.any_weight, cells);
  }
  std::set<std::size_t> techniques;
  bool all_digits = !cells.empty();
  for (const auto& [participant, row] : cells) {
    for (const auto& [technique, cell] : row) {
      techniques.insert(technique);
      all_digits = all_digits && cell.all_digits;
      table.single_pages = table.single_pages && cell.count == 1;
    }
  }
  table.techniques.assign(techniques.begin(), techniques.end());
  const std::int64_t common = common_count(cells);
  table.scale = 2.0 * static_cast<double>(common);
  for (const auto& [participant, row] : cells) {
    table.participants.push_back(participant);
    fill_row(row, common, table);
  }
  if (!all_digits) table.digits.clear();
  return table;
}

}  // namespace penumbra::study::statistics
