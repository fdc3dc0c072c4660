#pragma once

#include <string>
#include <utility>
#include <vector>

namespace penumbra::experiments::claims {

class Laboratory;

enum class Verdict {
  reproduced,
  in_part,
  not_reproduced,
  needs_gpu,  ///< measured on a processor: told, not judged
  needs_people,
  not_measured  ///< the set-up failed
};

/// As documents write it.
const char* name_of(Verdict verdict);

/// What a set-up measured.
struct Outcome {
  std::vector<std::pair<std::string, double>> numbers;  ///< in the order of tables
  std::vector<bool> parts;                              ///< of the rule: which of them hold
  std::string note;
  std::string figure;  ///< SVG; may be empty

  void number(const std::string& name, double value) { numbers.emplace_back(name, value); }
  void part(bool holds) { parts.push_back(holds); }
};

/// What a verdict takes beside a measurement.
enum class Needs {
  nothing,
  gpu,    ///< a ratio that hangs on fixed-function hardware: told on a processor, not judged
  people  ///< answers of participants: nothing is measured here
};

/// One published statement, and how it is judged.
struct Claim {
  std::string id;
  std::string source;     ///< document and place
  std::string statement;  ///< what was published
  std::string rule;       ///< what must hold of the numbers; parts separated by semicolons
  Outcome (*measure)(Laboratory&) = nullptr;  ///< null where it needs people
  Needs needs = Needs::nothing;
};

/// All claims, family by family.
const std::vector<Claim>& all();

/// Each family has a file of its own.
std::vector<Claim> published_claims();
std::vector<Claim> number_claims();
std::vector<Claim> survey_scene_claims();
std::vector<Claim> volume_claims();
std::vector<Claim> filter_claims();
std::vector<Claim> map_claims();
std::vector<Claim> layout_claims();
std::vector<Claim> tile_claims();
std::vector<Claim> tile_cost_claims();
std::vector<Claim> cost_claims();
std::vector<Claim> limit_claims();
std::vector<Claim> fleet_claims();
std::vector<Claim> run_time_choice_claims();
std::vector<Claim> waiting_claims();

}  // namespace penumbra::experiments::claims
