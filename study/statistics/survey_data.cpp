#include "study/statistics/survey_data.h"

#include <map>
#include <tuple>

namespace penumbra::study::statistics {

namespace {

/// Sums over the pages of a block for one technique.
struct Cell {
  std::int64_t doubled_ranks = 0;
  std::int64_t count = 0;
  double weighted = 0.0;
  double weight = 0.0;
  double digits = 0.0;
  double weighted_digits = 0.0;
  bool all_digits = true;
};

/// A row of cells per block; blocks are participants or pages, by their number.
using Cells = std::map<std::size_t, std::vector<Cell>>;

double doubled_rank(const PageAnswer& page, std::size_t technique, bool turned) {
  const double rank = page.doubled_ranks[technique];
  return turned ? 2.0 * (static_cast<double>(page.pictures) + 1.0) - rank : rank;
}

void add_page(const PageAnswer& page, bool turned, bool any_weight, std::vector<Cell>& row) {
  for (std::size_t i = 0; i < page.doubled_ranks.size(); ++i) {
    if (is_missing(page.doubled_ranks[i])) continue;
    const auto rank = static_cast<std::int64_t>(doubled_rank(page, i, turned));
    Cell& cell = row[i];
    cell.doubled_ranks += rank;
    ++cell.count;
    const double weight = any_weight ? page.weight.value_or(0.0) : 1.0;
    const double digit = turned ? 10.0 - page.digits[i] : page.digits[i];
    cell.weighted += weight * 0.5 * static_cast<double>(rank);
    cell.weight += weight;
    cell.all_digits = cell.all_digits && !is_missing(page.digits[i]);
    cell.digits += digit;
    cell.weighted_digits += weight * digit;
  }
}

/// Smallest number that every cell's count divides, so that scaled means are integers. Beyond the
/// bound, which takes many unequal counts, means are exact to about 1e-9 instead.
std::int64_t common_count(const Cells& cells) {
  constexpr std::int64_t bound = 1'000'000'000;
  std::int64_t common = 1;
  for (const auto& [block, row] : cells) {
    for (const Cell& cell : row) {
      if (cell.count == 0) continue;
      const std::int64_t next = std::lcm(common, cell.count);
      if (next > bound) return bound;
      common = next;
    }
  }
  return common;
}

void fill_row(const std::vector<Cell>& row, std::int64_t common, ParticipantTable& table) {
  const std::vector<double> blank(table.techniques.size(), missing);
  for (Table* values :
       {&table.scaled_ranks, &table.weighted_ranks, &table.digits, &table.weighted_digits})
    values->push_back(blank);
  table.weights.emplace_back(table.techniques.size(), 0.0);
  for (std::size_t i = 0; i < table.techniques.size(); ++i) {
    const Cell& cell = row[table.techniques[i]];
    if (cell.count == 0) continue;
    const auto count = static_cast<double>(cell.count);
    table.scaled_ranks.back()[i] =
        std::round(static_cast<double>(cell.doubled_ranks) * (static_cast<double>(common) / count));
    table.weights.back()[i] = cell.weight;
    if (cell.all_digits) table.digits.back()[i] = cell.digits / count;
    if (!(cell.weight > 0.0)) continue;
    table.weighted_ranks.back()[i] = cell.weighted / cell.weight;
    if (cell.all_digits) table.weighted_digits.back()[i] = cell.weighted_digits / cell.weight;
  }
}

/// Pictures of a page that share their rank with another.
std::size_t tied_pictures(const PageAnswer& page) {
  std::map<double, std::size_t> shared;
  for (const double rank : page.doubled_ranks) {
    if (!is_missing(rank)) ++shared[rank];
  }
  std::size_t tied = 0;
  for (const auto& [rank, count] : shared) tied += count > 1 ? count : 0;
  return tied;
}

}  // namespace

std::uint32_t Gatherer::Names::number(const std::string& name) {
  return numbers.try_emplace(name, static_cast<std::uint32_t>(numbers.size())).first->second;
}

std::pair<std::vector<std::string>, std::vector<std::size_t>> Gatherer::Names::sorted() const {
  const std::map<std::string, std::uint32_t> ordered(numbers.begin(), numbers.end());
  std::vector<std::string> names;
  std::vector<std::size_t> places(numbers.size());
  for (const auto& [name, number] : ordered) {
    places[number] = names.size();
    names.push_back(name);
  }
  return {names, places};
}

void Gatherer::add(const ResponseRow& row) {
  if (!row.included) taken_out.insert(row.participant);
  Row& kept = rows.emplace_back();
  kept.participant = participants.number(row.participant);
  if (!row.arm.empty()) arms.try_emplace(kept.participant, row.arm);
  kept.scene = scenes.number(row.scene);
  kept.technique = techniques.number(row.technique);
  kept.page_index = row.page_index;
  kept.repeat = row.repeat;
  kept.rank = row.rank;
  if (row.digit) kept.digit = digit_from_best(*row.digit, row.best_digit.value_or(1));
  if (row.slot) kept.slot = *row.slot;
  if (row.weight)
    kept.weight = *row.weight;
  else if (row.difficulty)
    kept.weight = *row.difficulty;
  if (row.active_ms) kept.active_ms = *row.active_ms;
}

PageAnswer Gatherer::page_of(const Row* first, const Row* last, std::size_t techniques) {
  PageAnswer page;
  page.participant = first->participant;
  page.scene = first->scene;
  page.page_index = first->page_index;
  page.repeat = first->repeat;
  page.pictures = static_cast<std::size_t>(last - first);
  page.doubled_ranks.assign(techniques, missing);
  page.digits = page.doubled_ranks;
  page.slots = page.doubled_ranks;
  std::vector<double> ranks;
  for (const Row* row = first; row != last; ++row) ranks.push_back(row->rank);
  const auto doubled = doubled_ranks(ranks);
  for (const Row* row = first; row != last; ++row) {
    page.doubled_ranks[row->technique] =
        static_cast<double>(doubled[static_cast<std::size_t>(row - first)]);
    page.digits[row->technique] = row->digit;
    page.slots[row->technique] = row->slot;
    if (!page.weight && !is_missing(row->weight)) page.weight = row->weight;
    if (!page.active_ms && !is_missing(row->active_ms)) page.active_ms = row->active_ms;
  }
  return page;
}

std::vector<std::string> Gatherer::arms_of(const std::vector<std::string>& names) const {
  std::vector<std::string> list;
  for (const auto& name : names) {
    const auto arm = arms.find(participants.numbers.at(name));
    list.push_back(arm == arms.end() ? "" : arm->second);
  }
  return list;
}

SurveyData Gatherer::finish() {
  // Leave out those who were taken out, with scenes and techniques that only they saw.
  Names kept_participants;
  Names kept_scenes;
  Names kept_techniques;
  const auto people = participants.sorted();
  const auto all_scenes = scenes.sorted();
  const auto all_techniques = techniques.sorted();
  std::erase_if(rows, [&](const Row& row) {
    return taken_out.contains(people.first[people.second[row.participant]]);
  });
  for (Row& row : rows) {
    row.participant = kept_participants.number(people.first[people.second[row.participant]]);
    row.scene = kept_scenes.number(all_scenes.first[all_scenes.second[row.scene]]);
    row.technique =
        kept_techniques.number(all_techniques.first[all_techniques.second[row.technique]]);
  }
  const auto [names, person_places] = kept_participants.sorted();
  const auto [scene_names, scene_places] = kept_scenes.sorted();
  const auto [technique_names, technique_places] = kept_techniques.sorted();
  for (Row& row : rows) {
    row.participant = static_cast<std::uint32_t>(person_places[row.participant]);
    row.scene = static_cast<std::uint32_t>(scene_places[row.scene]);
    row.technique = static_cast<std::uint32_t>(technique_places[row.technique]);
  }
  const auto page_key = [](const Row& row) {
    return std::make_tuple(row.participant, row.scene, row.page_index, row.repeat);
  };
  std::sort(rows.begin(), rows.end(), [&](const Row& a, const Row& b) {
    return std::tuple_cat(page_key(a), std::make_tuple(a.technique)) <
           std::tuple_cat(page_key(b), std::make_tuple(b.technique));
  });
  SurveyData data{names,       arms_of(names),
                  scene_names, technique_names,
                  {},          {taken_out.begin(), taken_out.end()}};
  for (auto first = rows.begin(); first != rows.end();) {
    const auto last = std::find_if(
        first, rows.end(), [&](const Row& row) { return page_key(row) != page_key(*first); });
    data.pages.push_back(page_of(&*first, &*first + (last - first), technique_names.size()));
    first = last;
  }
  return data;
}

SurveyData gather(const std::vector<ResponseRow>& rows) {
  Gatherer gatherer;
  for (const ResponseRow& row : rows) gatherer.add(row);
  return gatherer.finish();
}

ParticipantTable participant_table(const SurveyData& data, const Selection& selection,
                                   std::optional<std::size_t> scene, Blocks blocks) {
  ParticipantTable table;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < data.pages.size(); ++i) {
    const PageAnswer& page = data.pages[i];
    if (!selection.used[i] || page.repeat > 0 || (scene && page.scene != *scene)) continue;
    chosen.push_back(i);
    table.any_weight = table.any_weight || page.weight.has_value();
    table.tied += tied_pictures(page);
    table.ranked += page.pictures;
  }
  table.pages = chosen.size();
  Cells cells;
  for (const std::size_t i : chosen) {
    const PageAnswer& page = data.pages[i];
    auto& row = cells[blocks == Blocks::pages ? i : page.participant];
    row.resize(data.techniques.size());
    add_page(page, selection.turned[i], table.any_weight, row);
  }
  std::vector<bool> shown(data.techniques.size(), false);
  bool all_digits = !cells.empty();
  for (const auto& [block, row] : cells) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      shown[i] = shown[i] || row[i].count > 0;
      all_digits = all_digits && row[i].all_digits;
    }
  }
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (shown[i]) table.techniques.push_back(i);
  }
  const std::int64_t common = common_count(cells);
  table.scale = 2.0 * static_cast<double>(common);
  for (const auto& [block, row] : cells) {
    table.participants.push_back(blocks == Blocks::pages ? data.pages[block].participant : block);
    fill_row(row, common, table);
  }
  if (!all_digits) {
    table.digits.clear();
    table.weighted_digits.clear();
  }
  return table;
}

}  // namespace penumbra::study::statistics
