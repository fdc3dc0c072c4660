#include "study/responses.h"

namespace penumbra::study {

namespace {

/// Hash of the parameters as the study gave them: FNV-1a over the canonical text, 16 digits. It
/// tells pictures apart; nothing secret hangs on it.
std::string parameters_hash(const nlohmann::json& parameters) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char byte : parameters.dump()) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3ull;
  }
  std::string text(16, '0');
  for (std::size_t i = 0; i < 16; ++i) text[15 - i] = "0123456789abcdef"[(hash >> (4 * i)) & 15];
  return text;
}

}  // namespace

std::vector<ResponseRow> response_rows(const Study& study, const std::string& hash,
                                       const std::string& participant, const PlannedPage& planned,
                                       int page_index, const Answer& answer,
                                       const std::string& answered_at) {
  const Page& page = page_of(study, planned);
  const auto ranks = doubled_mid_ranks(answer.order());
  const auto facts = std::make_shared<PageFacts>();
  facts->seen = answer.observations;
  std::vector<ResponseRow> rows;
  for (std::size_t slot = 0; slot < planned.slots.size(); ++slot) {
    const Picture& picture = page.pictures.at(planned.slots[slot]);
    ResponseRow row;
    row.study = study.id;
    row.study_hash = hash;
    row.participant = participant;
    row.page_index = page_index;
    row.repeat = planned.kind == PageKind::repeat ? 1 : 0;
    row.scene = page.id;
    row.technique = picture.id;
    row.preset = picture.technique;
    row.parameters_hash = parameters_hash(picture.parameters);
    row.slot = static_cast<int>(slot);
    row.rank = ranks.at(slot) / 2.0;
    if (!answer.shelves.empty()) row.shelf = answer.shelves[slot];
    if (!answer.digits.empty()) row.digit = answer.digits[slot];
    if (answer.difficulty > 0) {
      row.difficulty = answer.difficulty;
      row.weight = answer.difficulty;
    }
    row.active_ms = answer.observations.active_ms;
    row.total_ms = answer.observations.total_ms;
    row.enlarged = answer.observations.enlargements;
    row.flipped = answer.observations.flips;
    row.swapped_direction = answer.observations.swaps > 0;
    row.answered_at = answered_at;
    row.page = facts;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace penumbra::study
