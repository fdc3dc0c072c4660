#include "study/statistics/provenance.h"

#include <Eigen/Core>
#include <boost/version.hpp>
#include <set>

#include "study/digest.h"

namespace penumbra::study::statistics {

namespace {

using nlohmann::json;

constexpr std::size_t few_participants = 12;

std::string boost_version() {
  return std::to_string(BOOST_VERSION / 100000) + "." + std::to_string(BOOST_VERSION / 100 % 1000) +
         "." + std::to_string(BOOST_VERSION % 100);
}

std::string eigen_version() {
  return std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
         std::to_string(EIGEN_MINOR_VERSION);
}

/// Warnings of one part of one set.
void warn_about(const json& part, const std::string& set, const std::string& name, json& list) {
  const auto warn = [&](const std::string& text) {
    list.push_back({{"set", set}, {"part", name}, {"warning", text}});
  };
  if (part["pages"] == 0) return warn("no pages");
  const auto participants = part["participants"].get<std::size_t>();
  if (participants < few_participants) {
    warn("few participants (" + std::to_string(participants) + "): intervals are wide, and " +
         part["family"].value("note", "there are no pairs to test"));
  }
  if (part["tie_rate"] == 1.0) warn("all pictures are tied");
  const json& worths = part["plackett_luce"];
  if (worths.contains("groups")) {
    warn("not connected: " + worths["groups"].dump() + " were never compared with each other");
  }
  const auto complete = part["complete_participants"].get<std::size_t>();
  if (complete < participants) {
    warn(std::to_string(participants - complete) +
         " participants did not see all pictures: Friedman's W and F, Quade, Nemenyi and Conover "
         "use "
         "the " +
         std::to_string(complete) + " who did; missing pictures are never ranked last");
  }
}

/// Which ranks enter, and with what weights.
json rank_methods() {
  return {{"ranks", "mid-ranks among the pictures of a page"},
          {"ranks_of",
           "means, weighted means and order: of the digits, from 1 for the best, where all pages "
           "have them (the 2007 study averaged digits), otherwise of mid-ranks; tests on ranks: of "
           "mid-ranks"},
          {"blocks", "participants; the pooled part takes each participant's mean mid-ranks"},
          {"arms",
           "where people were assigned to several ways of giving ranks: read_right counts those "
           "without the flag inverted, judged against the means of all arms; ci95 by Clopper and "
           "Pearson; p of each two arms by Fisher's exact test, two-sided, and after Holm"},
          {"repeats", "measure reliability only"},
          {"weights",
           "difficulty 1 to 5; weighted mean sum(w r) / sum(w), standard error HC1, effective n by "
           "Kish; never frequencies"},
          {"order", "by weighted mean rank"},
          {"intervals",
           "ci95: Student's t; bca95: bias-corrected and accelerated, participants drawn whole"},
          {"inverted", "people turned round: rank r becomes n + 1 - r, digit d becomes 10 - d"}};
}

/// Tests of differences, and what is shown beside them.
json test_methods() {
  return {
      {"paired_t",
       "unweighted, two-sided; the 2007 study does not say whether its test was weighted"},
      {"subsets", "maximal sets of techniques whose paired t does not differ, Bonferroni"},
      {"runs",
       "as tables 4.3 to 4.9 of 2007: neighbours in the order; pairs_without_run names pairs that "
       "do not differ and share no run"},
      {"pooled_rows",
       "pages as if each were a participant: unsound, for comparison with 2007 only"},
      {"friedman",
       "tie-corrected; quadratic form with pseudo-inverse, so that incomplete blocks give Durbin's "
       "and, with their weights, Skillings and Mack's test; permutation p up to 30 complete "
       "blocks"},
      {"quade", "on mid-ranks"},
      {"wilcoxon",
       "V = W+; zeros dropped; exact below 50 differences without ties or zeros, otherwise normal "
       "with tie and continuity correction; p_exact_conditional permutes mid-ranks, up to 100 "
       "differences; p_pratt ranks zeros with the others and then drops them"},
      {"sign", "ties dropped in p, half in probability_a_better and its Clopper-Pearson interval"},
      {"effects",
       "dz with noncentral t; matched rank-biserial with Fisher's z; probability_a_better"},
      {"adjustment", "Holm is primary; Bonferroni, Hochberg and Shaffer's static procedure beside"},
      {"families", "all pairs of one table"}};
}

/// Models of what is behind the ranks, and measures of the pictures.
json model_methods() {
  return {{"plackett_luce",
           "maximum likelihood with ties of any order, every page a ranking; log worths sum to 0; "
           "se, robust_se clustered by participant, quasi_se; regularised: each technique wins and "
           "loses half a comparison with an imaginary one"},
          {"bradley_terry", "a tie is half a win; a check of the worths, without errors"},
          {"jod",
           "Thurstone's case V with the distance prior of Perez-Ortiz and Mantiuk 2017; ties are "
           "half wins; robust_se clustered by participant, from the likelihood without the prior"},
          {"bt500",
           "ITU-R BT.500-13, annex 2, 2.3.1; for comparison only: in small groups people who read "
           "the scale backwards widen its limits and pass"},
          {"objective", "within scenes first, pooled by ranks within scenes second"}};
}

}  // namespace

json counts_json(const SurveyData& data, const std::vector<Flag>& flags) {
  std::vector<std::set<std::size_t>> scenes(data.participants.size());
  for (const PageAnswer& page : data.pages) {
    if (page.repeat == 0) scenes[page.participant].insert(page.scene);
  }
  std::size_t completed = 0;
  for (const auto& seen : scenes) completed += seen.size() == data.scenes.size() ? 1 : 0;
  std::set<std::size_t> flagged;
  std::set<std::size_t> inverted;
  for (const Flag& flag : flags) {
    flagged.insert(flag.participant);
    if (flag.name == "inverted") inverted.insert(flag.participant);
  }
  return {{"entered", data.participants.size() + data.taken_out.size()},
          {"taken_out", data.taken_out.size()},
          {"analysed", data.participants.size()},
          {"completed", completed},
          {"stopped_early", data.participants.size() - completed},
          {"flagged", flagged.size()},
          {"inverted", inverted.size()}};
}

json methods_json(const ReportOptions& options) {
  json methods = {{"alpha", options.plan.alpha},
                  {"seed", options.resampling.seed},
                  {"resamples", options.resampling.resamples},
                  {"permutations", options.resampling.permutations},
                  {"versions", {{"boost", boost_version()}, {"eigen", eigen_version()}}}};
  for (const json& part : {rank_methods(), test_methods(), model_methods()}) methods.update(part);
  return methods;
}

std::string data_digest(const SurveyData& data) {
  std::string text;
  for (const PageAnswer& page : data.pages) {
    text += data.participants[page.participant] + "\n" + data.scenes[page.scene] + "\n" +
            std::to_string(page.page_index) + " " + std::to_string(page.repeat) + " " +
            json(page.weight.value_or(-1.0)).dump() + "\n";
    for (std::size_t i = 0; i < data.techniques.size(); ++i) {
      if (is_missing(page.doubled_ranks[i])) continue;
      text += data.techniques[i] + " " +
              std::to_string(static_cast<std::int64_t>(page.doubled_ranks[i]));
      if (!is_missing(page.digits[i])) text += " " + json(page.digits[i]).dump();
      text += "\n";
    }
  }
  return sha256(text);
}

json notes_json(const SurveyData& data) {
  json notes = json::array();
  std::size_t weighted = 0;
  for (const auto& page : data.pages) weighted += page.weight ? 1 : 0;
  if (weighted == 0 && !data.pages.empty()) {
    notes.push_back("no page has a difficulty: every page weighs 1");
  } else if (weighted < data.pages.size()) {
    notes.push_back(std::to_string(data.pages.size() - weighted) +
                    " pages without a difficulty are left out of weighted means");
  }
  if (!data.taken_out.empty()) {
    notes.push_back(std::to_string(data.taken_out.size()) +
                    " participants were taken out by a researcher");
  }
  return notes;
}

json warnings_json(const json& report) {
  json list = json::array();
  for (const auto& [name, set] : report["included_sets"].items()) {
    for (const json& scene : set["scenes"]) warn_about(scene, name, scene["scene"], list);
    warn_about(set["overall"], name, "overall", list);
  }
  return list;
}

}  // namespace penumbra::study::statistics
