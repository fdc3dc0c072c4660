#include "study/responses.h"

namespace penumbra::study {

std::vector<ResponseRow> response_rows(const Study& study, const std::string& hash,
                                       const std::string& participant, const Arm& arm,
                                       const PlannedPage& planned, int page_index,
                                       const Answer& answer, const std::string& answered_at) {
  const Page& page = page_of(study, planned);
  const auto ranks = doubled_mid_ranks(answer.order);
  const auto facts = std::make_shared<PageFacts>();
  facts->seen = answer.observations;
  std::vector<ResponseRow> rows;
  for (std::size_t slot = 0; slot < planned.slots.size(); ++slot) {
    const Picture& picture = page.pictures.at(planned.slots[slot]);
    ResponseRow row;
    row.study = study.id;
    row.study_hash = hash;
    row.participant = participant;
    row.arm = arm.id;
    row.page_index = page_index;
    row.repeat = planned.kind == PageKind::repeat ? 1 : 0;
    row.scene = page.id;
    row.technique = picture.id;
    row.preset = picture.technique;
    row.own_picture = picture.own;
    row.parameters_hash = picture.parameters_hash;
    row.slot = static_cast<int>(slot);
    row.rank = ranks.at(slot) / 2.0;
    if (!answer.shelves.empty()) row.shelf = answer.shelves[slot];
    if (!answer.digits.empty()) {
      row.digit = answer.digits[slot];
      row.best_digit = arm.best_digit;
    }
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
