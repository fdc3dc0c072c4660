#include "experiments/claims/run.h"

#include <algorithm>

#include "experiments/claims/laboratory.h"
#include "experiments/claims/report.h"
#include "renderer/error.h"

namespace penumbra::experiments::claims {
namespace {

using nlohmann::json;

std::vector<const Claim*> chosen(const std::vector<std::string>& only) {
  std::vector<const Claim*> list;
  std::string ids;
  for (const Claim& claim : all()) {
    ids += (ids.empty() ? "" : " ") + claim.id;
    if (only.empty() || std::find(only.begin(), only.end(), claim.id) != only.end())
      list.push_back(&claim);
  }
  for (const std::string& id : only)
    if (std::none_of(list.begin(), list.end(), [&](const Claim* c) { return c->id == id; }))
      throw bad_value("only", "there is no claim '" + id + "'; claims are " + ids);
  return list;
}

/// Errors of the machine end the run; others are of one claim.
bool ends_the_run(const Error& error) {
  return error.code == "device" || error.code == "unwritable" || error.code == "busy" ||
         error.field == "out";
}

Judged judge(const Claim& claim, Laboratory& lab) {
  Judged judged{&claim, {}, Verdict::not_measured};
  if (claim.needs == Needs::people) {
    judged.verdict = Verdict::needs_people;
    return judged;
  }
  try {
    judged.outcome = claim.measure(lab);
  } catch (const Error& error) {
    if (ends_the_run(error)) throw;
    judged.outcome.note = std::string("not measured: ") + error.what();
    return judged;
  }
  const bool on_gpu = lab.has_engine() && lab.engine().device().type != "cpu";
  judged.verdict =
      claim.needs == Needs::gpu && !on_gpu ? Verdict::needs_gpu : verdict_of(judged.outcome.parts);
  return judged;
}

json document_of(const std::vector<Judged>& list) {
  json claims = json::array();
  for (const Judged& judged : list) {
    json numbers = json::object();
    for (const auto& [name, value] : judged.outcome.numbers) numbers[name] = value;
    claims.push_back({{"id", judged.claim->id},
                      {"statement", judged.claim->statement},
                      {"source", judged.claim->source},
                      {"rule", judged.claim->rule},
                      {"verdict", name_of(judged.verdict)},
                      {"numbers", numbers},
                      {"note", judged.outcome.note}});
  }
  return claims;
}

}  // namespace

const std::vector<Claim>& all() {
  static const std::vector<Claim> list = [] {
    std::vector<Claim> claims;
    for (const auto& family : {published_claims(), number_claims(), survey_scene_claims(),
                               volume_claims(), filter_claims(), map_claims(), layout_claims(),
                               tile_claims(), tile_cost_claims(), cost_claims(), limit_claims(),
                               fleet_claims(), run_time_choice_claims(), waiting_claims()})
      claims.insert(claims.end(), family.begin(), family.end());
    return claims;
  }();
  return list;
}

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::reproduced:
      return "reproduced";
    case Verdict::in_part:
      return "in part";
    case Verdict::not_reproduced:
      return "not reproduced";
    case Verdict::needs_gpu:
      return "needs a GPU";
    case Verdict::needs_people:
      return "needs people";
    case Verdict::not_measured:
      break;
  }
  return "not measured";
}

Verdict verdict_of(const std::vector<bool>& parts) {
  const auto held = std::count(parts.begin(), parts.end(), true);
  if (held == 0) return Verdict::not_reproduced;
  return held == static_cast<std::ptrdiff_t>(parts.size()) ? Verdict::reproduced : Verdict::in_part;
}

json run(const Options& options) {
  const auto list = chosen(options.only);
  make_folder(options.engine.folder);
  Laboratory lab(options.engine, options.quick ? quick_scale() : full_scale());
  std::vector<Judged> judged;
  const auto tell = [&](const std::string& what) {
    if (options.progress)
      options.progress({judged.size(), list.size(),
                        lab.has_engine() ? lab.engine().measured() : std::size_t{0}, std::nullopt,
                        what});
  };
  for (const Claim* claim : list) {
    lab.before = [&](const std::string& what) { tell(claim->id + " " + what); };
    tell(claim->id);
    judged.push_back(judge(*claim, lab));
  }
  tell("");
  json device = nullptr;
  if (lab.has_engine())
    device = {{"name", lab.engine().device().name},
              {"driver", lab.engine().device().driver},
              {"type", lab.engine().device().type}};
  const auto files =
      write_report(options.engine.folder, device, options.command, judged, lab.rows());
  if (!options.page.empty()) write_page(options.page, device, options.command, judged);
  return {{"claims", document_of(judged)},
          {"device", device},
          {"measured", lab.has_engine() ? lab.engine().measured() : std::size_t{0}},
          {"files", files}};
}

}  // namespace penumbra::experiments::claims
