// The claim that a technique is better chosen when a program is written than while it runs
// (Sindholt 2005).
#include <algorithm>
#include <cmath>
#include <string>

#include "experiments/claims/claim.h"
#include "experiments/claims/laboratory.h"
#include "experiments/recommend/model.h"
#include "experiments/report/rows.h"
#include "renderer/error.h"
#include "renderer/metrics/frame_change.h"

namespace penumbra::experiments::claims {
namespace {

using recommend::Budget;
using recommend::Known;
using recommend::Probes;

/// No measured set that recommendations learn from has them.
const std::vector<std::string> unseen_scenes{"village", "tower", "water-tower"};
const std::vector<std::string> path_candidates{"shadow-map",
                                               "pcf",
                                               "pcf:map_size=1024",
                                               "pcss",
                                               "vsm",
                                               "shadow-volumes",
                                               "ray-traced",
                                               "ray-traced:rays=16",
                                               "soft-shadow-volumes"};

/// A camera that goes around what it looks at.
constexpr int path_frames = 4;
constexpr double degrees_a_frame = 15.0;

/// Of the scene's frames without shadows, on average along the path.
constexpr double budget_times_none = 2.5;

Run run_of(const Laboratory& lab, const std::string& scene, const std::string& technique,
           int frame) {
  const NamedTechnique named = read_technique(technique);
  Run run;
  run.scene = scene;
  run.technique = named.id;
  run.parameters = named.parameters;
  run.name = technique + " turned by " + std::to_string(frame * int(degrees_a_frame));
  run.width = run.height = lab.scale().size;
  run.light_samples = lab.scale().light_samples;
  run.truth = Truth::area;
  run.view.camera_turn = degrees_a_frame * frame;
  return run;
}

struct Frame {
  Known none;
  Probes known;  ///< what draws it
};

/// What was measured of a scene along the path.
struct Path {
  std::string scene;
  std::vector<Frame> frames;
  Budget budget;
};

Path measure_path(Laboratory& lab, const std::string& scene) {
  Path path{scene, {}, {}};
  const auto known = [](const nlohmann::json& row) {
    return Known{number_of(row, "rms_y"), number_of(row, "frame_ms"),
                 number_of(row, "memory_bytes")};
  };
  for (int i = 0; i < path_frames; ++i) {
    Frame frame{known(lab.row(run_of(lab, scene, "none", i))), {}};
    for (const std::string& candidate : path_candidates) {
      const nlohmann::json& row = lab.row(run_of(lab, scene, candidate, i));
      if (is_done(row)) frame.known[candidate] = known(row);
    }
    if (frame.known.empty()) throw unsupported("no technique draws " + scene);
    path.budget.ms += budget_times_none * frame.none.ms / path_frames;
    path.frames.push_back(std::move(frame));
  }
  return path;
}

/// One choice a frame.
using Choices = std::vector<std::string>;

/// Error of a choice in a frame, as a share of that without shadows. What cannot be drawn within
/// the budget counts as drawn without.
double share_of(const Path& path, const Frame& frame, const std::string& choice) {
  const auto found = frame.known.find(choice);
  const bool fits = found != frame.known.end() && path.budget.holds(found->second);
  return fits ? found->second.error / frame.none.error : 1.0;
}

/// The least of the shares' means over all frames of the paths.
std::string best_for(const std::vector<const Path*>& paths) {
  std::string best;
  double least = 0.0;
  for (const std::string& candidate : path_candidates) {
    double sum = 0.0;
    for (const Path* path : paths)
      for (const Frame& frame : path->frames) sum += share_of(*path, frame, candidate);
    if (best.empty() || sum < least) {
      best = candidate;
      least = sum;
    }
  }
  return best;
}

std::string recommended(Laboratory& lab, const Path& path, const Frame& frame) {
  const auto measured = recommend::measured_before(lab.engine().device().type != "cpu", "rms_y");
  std::vector<std::string> names;
  for (const auto& [name, known] : frame.known) names.push_back(name);
  const auto choice = recommend::choose(
      measured, names, frame.none, path.budget,
      [&](const std::string& name) -> std::optional<Known> { return frame.known.at(name); });
  return choice.candidate;
}

struct Arm {
  double regret = 0.0;  ///< error above that of the best choice a frame, of that without shadows
  int missed = 0;       ///< frames over the budget
};

/// Counts a path's choices against the best a frame.
void count(Arm& arm, const Path& path, const Choices& choices, const Choices& best) {
  for (std::size_t i = 0; i < path.frames.size(); ++i) {
    const Frame& frame = path.frames[i];
    const auto found = frame.known.find(choices[i]);
    arm.missed += found == frame.known.end() || !path.budget.holds(found->second);
    arm.regret += (share_of(path, frame, choices[i]) - share_of(path, frame, best[i])) /
                  static_cast<double>(path.frames.size() * unseen_scenes.size());
  }
}

/// Both frames of a path of two cameras that ends at `frame`.
std::vector<PathFrame> two_frames(Laboratory& lab, const std::string& scene,
                                  const std::string& technique, int frame) {
  RenderRequest request = lab.engine().request_of(run_of(lab, scene, technique, frame));
  request.earlier_cameras = {
      seen_from(*lab.engine().scene(scene), {.camera_turn = degrees_a_frame * (frame - 1)})
          .cameras.front()};
  std::vector<PathFrame> frames;
  RenderControl control;
  control.path_frame = [&](PathFrame each) { frames.push_back(std::move(each)); };
  if (lab.before) lab.before(scene + " " + technique);
  lab.engine().renderer().render(request, control);
  return frames;
}

metrics::FrameChange change_of(PathFrame before, PathFrame now) {
  metrics::FrameChange change;
  change.add(std::move(before));
  change.add(std::move(now));
  return change;
}

/// Visibility that jumps beyond the reference's own, where the best choice changes and where it is
/// kept.
struct Jumps {
  double switching = 0.0, keeping = 0.0;
  int switches = 0;
};

void add_jumps(Laboratory& lab, const Path& path, const Choices& best, Jumps& jumps) {
  for (int i = 1; i < path_frames; ++i) {
    const auto place = static_cast<std::size_t>(i);
    if (best[place] == best[place - 1]) continue;
    const auto before = two_frames(lab, path.scene, best[place - 1], i);
    const auto now = two_frames(lab, path.scene, best[place], i);
    const auto truth = two_frames(lab, path.scene, "reference", i);
    const auto reference = change_of(truth[0], truth[1]);
    jumps.switching += metrics::frame_difference(change_of(before[0], now[1]), reference);
    jumps.keeping += 0.5 * (metrics::frame_difference(change_of(before[0], before[1]), reference) +
                            metrics::frame_difference(change_of(now[0], now[1]), reference));
    ++jumps.switches;
  }
}

Outcome c14(Laboratory& lab) {
  std::vector<Path> paths;
  for (const std::string& scene : unseen_scenes) paths.push_back(measure_path(lab, scene));
  std::vector<const Path*> every;
  for (const Path& path : paths) every.push_back(&path);
  Arm all, borrowed, own, by_scene, by_frame;
  Jumps jumps;
  for (const Path& path : paths) {
    Choices best, a_frame;
    for (const Frame& frame : path.frames) {
      best.push_back(recommend::best_of(frame.known, path.budget, 0.0));
      a_frame.push_back(recommended(lab, path, frame));
    }
    std::vector<const Path*> others;
    for (const Path& other : paths)
      if (&other != &path) others.push_back(&other);
    const auto always = [&](const std::string& choice) {
      return Choices(path.frames.size(), choice);
    };
    count(all, path, always(best_for(every)), best);
    count(borrowed, path, always(best_for(others)), best);
    count(own, path, always(best_for({&path})), best);
    count(by_scene, path, always(recommended(lab, path, path.frames.front())), best);
    count(by_frame, path, a_frame, best);
    add_jumps(lab, path, best, jumps);
  }
  Outcome outcome;
  const auto tell = [&](const std::string& name, const Arm& arm) {
    outcome.number("regret of " + name, arm.regret);
    outcome.number("frames over the budget, " + name, arm.missed);
  };
  tell("one choice for all", all);
  tell("the best of the other scenes", borrowed);
  tell("the best a scene", own);
  tell("recommend, a scene", by_scene);
  tell("recommend, a frame", by_frame);
  outcome.number("switches of the best a frame", jumps.switches);
  bool visible = false;
  if (jumps.switches > 0) {
    outcome.number("jump at a switch", jumps.switching / jumps.switches);
    outcome.number("between frames of one technique", jumps.keeping / jumps.switches);
    visible = jumps.switching > 2.0 * jumps.keeping;
  }
  outcome.part(own.regret < 0.03 || visible);
  outcome.note =
      "regret: error above that of the best choice in each frame, as a share of that without "
      "shadows; the budget is 2.5 times the frame without shadows, and what is over it counts as "
      "drawn without";
  return outcome;
}

}  // namespace

std::vector<Claim> run_time_choice_claims() {
  return {
      {"C14", "S4 abstract, 1.2",
       "choosing the algorithm at design time beats choosing it at run time",
       "on three scenes that the model never saw, a camera going 45 degrees around each: the best "
       "choice a scene is within 0.03 of the best a frame, or a switch jumps over twice as far "
       "as frames of one technique do",
       c14}};
}

}  // namespace penumbra::experiments::claims
