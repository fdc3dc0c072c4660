#include "server/jobs/task.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>

#include "renderer/error.h"
#include "renderer/metrics/frame_change.h"
#include "renderer/metrics/metrics.h"
#include "renderer/technique.h"
#include "requests/fields.h"
#include "scenes/picture_io.h"
#include "server/jobs/device_lock.h"

namespace penumbra::server {
namespace {

using nlohmann::json;

/// How long one who draws waits for another's measurement, and how long one who measures waits for
/// the others to finish their pictures, seconds.
constexpr double draw_patience_s = 30.0;
constexpr double measure_patience_s = 20.0;

/// Time budget when the request names no number of frames, milliseconds.
constexpr double timing_budget_ms = 2500.0;
constexpr std::uint32_t fewest_frames = 1;

/// The same for frames without shadows, which no technique's are faster than; at least two of them,
/// so that what is compiled is not in their time.
constexpr double baseline_budget_ms = 500.0;
constexpr std::uint32_t fewest_baseline_frames = 2;

/// A frame that takes longer is timed the once that it is drawn: what is compiled in it is a small
/// part of it, and waiting for it again gains nothing.
constexpr double longest_repeated_ms = 2000.0;

json number_or_null(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

/// Frames that fit a budget at so many milliseconds each, the uncounted first one included.
std::uint32_t affordable_frames(double frame_ms, double budget_ms = timing_budget_ms) {
  const double count = frame_ms > 0.0 ? budget_ms / frame_ms - 1.0 : requests::default_frames;
  return static_cast<std::uint32_t>(
      std::clamp(count, double{fewest_frames}, double{requests::default_frames}));
}

double frame_ms_of(const Cost& cost) {
  return std::max(cost.wall_median_ms, cost.median_ms);
}

std::uint32_t frames_to_time(Renderer& renderer, const Task& task, const Cost& first,
                             std::vector<std::string>& notes) {
  if (task.request.frames > 0) return task.request.frames;
  double frame_ms = frame_ms_of(first);
  // The very first frame may have spent its time compiling; only a second one tells.
  if (affordable_frames(frame_ms) < requests::default_frames)
    frame_ms = frame_ms_of(renderer.render(to_render_request(task.request)).cost);
  const std::uint32_t frames = affordable_frames(frame_ms);
  if (frames < requests::default_frames)
    notes.push_back("timed over " + std::to_string(frames) + " frames instead of " +
                    std::to_string(requests::default_frames) + ", since one takes " +
                    std::to_string(std::lround(frame_ms)) + " ms");
  return frames;
}

json cost_to_json(const Cost& cost) {
  json passes = json::array();
  for (const PassCost& pass : cost.passes)
    passes.push_back({{"name", pass.name},
                      {"median_ms", pass.median_ms},
                      {"vertices", pass.vertices},
                      {"primitives", pass.primitives},
                      {"vertex_invocations", pass.vertex_invocations},
                      {"geometry_invocations", pass.geometry_invocations},
                      {"geometry_primitives", pass.geometry_primitives},
                      {"clipped_primitives", pass.clipped_primitives},
                      {"fragment_invocations", pass.fragment_invocations},
                      {"compute_invocations", pass.compute_invocations}});
  json resources = json::array();
  std::uint64_t bytes = 0;
  for (const ResourceCost& resource : cost.technique_memory) {
    resources.push_back({{"name", resource.name}, {"bytes", resource.bytes}});
    bytes += resource.bytes;
  }
  return {{"frame_ms",
           {{"median", cost.median_ms},
            {"p95", cost.p95_ms},
            {"spread", cost.spread},
            {"frames", cost.frames},
            {"settled", cost.settled}}},
          {"wall_median_ms", cost.wall_median_ms},
          {"create_ms", cost.create_ms},
          {"passes", passes},
          {"memory", {{"over_none_bytes", bytes}, {"resources", resources}}}};
}

/// Wall time of the counted frames and of raising clocks before them.
double drawing_ms(const Cost& cost) {
  return cost.settling_ms + cost.timing_ms;
}

/// Maps the parts of a task onto one bar.
class Parts {
 public:
  Parts(const std::function<void(double)>& progress, int count)
      : progress_(progress), count_(count) {}
  std::function<void(double)> next() {
    const int part = part_++;
    return [this, part](double value) {
      if (progress_) progress_((part + std::clamp(value, 0.0, 1.0)) / count_);
    };
  }

 private:
  const std::function<void(double)>& progress_;
  int count_;
  int part_ = 0;
};

/// Times frames of the technique. `first` is the picture's own.
Cost time_frames(Renderer& renderer, const Task& task, const RenderResult& first,
                 const std::function<void(double)>& progress, std::vector<std::string>& notes) {
  if (task.request.frames == 0 && frame_ms_of(first.cost) > longest_repeated_ms) {
    notes.push_back("timed over its first and only frame, which took " +
                    std::to_string(std::lround(frame_ms_of(first.cost))) + " ms");
    return first.cost;
  }
  RenderRequest request = to_render_request(task.request);
  request.frames = frames_to_time(renderer, task, first.cost, notes);
  request.settle = true;
  return renderer.render(request, {.progress = progress}).cost;
}

/// Times the same view without shadows, in the same breath: a device's clocks and a machine's other
/// work change absolute times, and the ratio less.
Cost time_baseline(Renderer& renderer, const Task& task, const Cost& cost,
                   const std::function<void(double)>& progress) {
  const CanonicalRequest baseline = baseline_of(task.request);
  if (baseline.technique.technique == task.request.technique.technique) {
    Cost own = cost;
    own.timing_ms = own.settling_ms = 0.0;  // nothing more is drawn
    return own;
  }
  RenderRequest request = to_render_request(baseline);
  request.frames =
      std::max(fewest_baseline_frames,
               task.request.frames > 0 ? task.request.frames
                                       : affordable_frames(frame_ms_of(cost), baseline_budget_ms));
  request.settle = true;
  return renderer.render(request, {.progress = progress}).cost;
}

json measure_cost(Renderer& renderer, const Task& task, const RenderResult& first, Parts& parts,
                  std::vector<std::string>& notes) {
  const Cost cost = time_frames(renderer, task, first, parts.next(), notes);
  const Cost baseline = time_baseline(renderer, task, cost, parts.next());
  json document = cost_to_json(cost);
  json& frame = document.at("frame_ms");
  frame["settled"] = cost.settled && baseline.settled;
  frame["none_median"] = baseline.median_ms;
  document["timing_ms"] = drawing_ms(cost) + drawing_ms(baseline);
  frame["over_none"] = number_or_null(cost.median_ms / baseline.median_ms);
  if (!frame.at("settled").get<bool>())
    notes.push_back("the device's clocks were not up throughout: do not compare its times");
  return document;
}

/// SSIM needs a window of 11 x 11; smaller pictures have none.
json ssim_or_null(const Image8& picture, const Image8& reference, std::vector<std::string>& notes) {
  try {
    return metrics::ssim(picture, reference);
  } catch (const Error& error) {
    notes.push_back(std::string("no ssim: ") + error.what());
    return nullptr;
  }
}

bool judges_path(const Task& task, const RenderRequest& request) {
  return task.wants.contains(want::quality) && !request.earlier_cameras.empty();
}

/// Change from frame to frame beyond the reference's own, or null where no frame shows a point of
/// the one before. The kept reference knows the end of the path only: all of it is drawn.
json path_difference(Renderer& renderer, const Task& task, const metrics::FrameChange& drawn,
                     const std::vector<Camera>& earlier_cameras,
                     const std::function<void(double)>& progress) {
  if (drawn.points() == 0) return nullptr;
  RequestContext context;
  context.device = task.request.request.at("device");
  RenderRequest request = to_render_request(reference_of(task.request, context));
  request.earlier_cameras = earlier_cameras;
  request.visibility = true;
  metrics::FrameChange reference;
  RenderControl control;
  control.progress = progress;
  control.path_frame = [&](PathFrame frame) { reference.add(std::move(frame)); };
  const DeviceLock drawing(DeviceLock::Mode::draw, draw_patience_s);
  renderer.render(request, control);
  return metrics::frame_difference(drawn, reference);
}

/// Decodes what a picture is judged by, in threads: it is there before the picture is.
class DecodedReference {
 public:
  /// `files` outlive this.
  DecodedReference(const std::set<std::string>& wants, const ReferencePictures& files) {
    if (needs_reference(wants))
      picture_ = std::async([&files] { return scenes::decode_picture(files.image); });
    if (wants.contains(want::quality))
      visibility_ = std::async([&files] { return scenes::decode_exr(files.visibility); });
  }
  /// So that nothing else runs while frames are timed.
  void wait() const {
    if (picture_.valid()) picture_.wait();
    if (visibility_.valid()) visibility_.wait();
  }
  const Image8& picture() { return picture_.get(); }
  const ImageF& visibility() { return visibility_.get(); }

 private:
  std::shared_future<Image8> picture_;
  std::shared_future<ImageF> visibility_;
};

json measure_quality(const Task& task, const RenderResult& drawn, DecodedReference& truth,
                     std::vector<std::string>& notes) {
  auto judging = std::async([&drawn, &visibility = truth.visibility()] {
    return metrics::visibility_error(drawn.visibility, visibility, drawn.judged);
  });
  const Image8& reference = truth.picture();
  const double flip = metrics::flip(drawn.picture, reference);
  const metrics::VisibilityError error = judging.get();
  if (task.reference.id == task.request.id) notes.push_back("this picture is the reference itself");
  if (error.judged == 0) notes.push_back("no pixel faces a light: visibility was not judged");
  const auto judged = [&error](double value) { return error.judged ? json(value) : json(nullptr); };
  return {{"reference_id", task.reference.id},
          {"reference_noise_rms_y", task.reference.noise_rms_y},
          {"rms_y", metrics::rms_y(drawn.picture, reference)},
          // Equal pictures have no finite ratio; JSON has no infinity.
          {"psnr", number_or_null(metrics::psnr(drawn.picture, reference))},
          {"ssim", ssim_or_null(drawn.picture, reference, notes)},
          {"flip", flip},
          {"visibility_rms", judged(error.rms)},
          {"visibility_bias", judged(error.bias)},
          {"false_shadow", judged(error.false_shadow)},
          {"missing_shadow", judged(error.missing_shadow)}};
}

/// Files that are encoded beside each other and beside the judging of their picture, or when they
/// are taken where no thread is to be had. What they are made of outlives this.
class FilesBeingMade {
 public:
  void make(const char* name, std::function<std::string()> encode) {
    files_.emplace_back(name, std::async(std::move(encode)));
  }
  /// Waits for them.
  void take(std::map<std::string, std::string>& files) {
    for (auto& [name, file] : files_) files[name] = file.get();
  }

 private:
  std::vector<std::pair<std::string, std::future<std::string>>> files_;
};

}  // namespace

const std::vector<std::string>& artefact_names() {
  static const std::vector<std::string> names{want::image, want::linear, want::visibility,
                                              want::error_map};
  return names;
}

bool needs_reference(const std::set<std::string>& wants) {
  return wants.contains(want::quality) || wants.contains(want::error_map);
}

json device_to_json(const DeviceInfo& device) {
  return {{"name", device.name}, {"driver", device.driver}, {"type", device.type}};
}

TaskResult run_task(Renderer& renderer, const Task& task,
                    const std::function<void(double)>& progress) {
  const auto wanted = [&task](const char* name) { return task.wants.contains(name); };
  // Draw once with everything that the wanted files are made of.
  RenderRequest request = to_render_request(task.request);
  const bool along_path = judges_path(task, request);
  Parts parts(progress, (wanted(want::cost) ? 3 : 1) + (along_path ? 1 : 0));
  metrics::FrameChange change;
  RenderControl control;
  control.progress = parts.next();
  if (along_path) control.path_frame = [&](PathFrame frame) { change.add(std::move(frame)); };
  request.visibility = wanted(want::visibility) || wanted(want::quality);
  request.linear = wanted(want::linear);
  request.uncertainty = wanted(want::noise);
  TaskResult result;
  DecodedReference reference(task.wants, task.reference);
  RenderResult drawn;
  if (wanted(want::cost)) {
    // Nothing else may draw while frames are timed, and the first may be the only one.
    const DeviceLock alone(DeviceLock::Mode::measure, measure_patience_s);
    // On a processor decoding takes its share of the time of that first frame.
    if (renderer.device().type == "cpu") reference.wait();
    drawn = renderer.render(request, control);
    reference.wait();
    result.cost = measure_cost(renderer, task, drawn, parts, result.notes);
    if (!alone.held()) result.notes.push_back("measured while another render shared the device");
  } else {
    const DeviceLock drawing(DeviceLock::Mode::draw, draw_patience_s);
    Checkpoint checkpoint(task.checkpoints, task.request.id);
    control.between_parts = [&](const auto& state) { checkpoint.offer(state); };
    control.resume = checkpoint.load();
    drawn = renderer.render(request, control);
    checkpoint.remove();
  }
  const std::vector<std::string>& of_scene = task.request.scene->notes;
  result.notes.insert(result.notes.begin(), drawn.notes.begin(), drawn.notes.end());
  result.notes.insert(result.notes.begin(), of_scene.begin(), of_scene.end());

  FilesBeingMade files;
  const Image8& shown = request.diagnostic.empty() ? drawn.picture : drawn.diagnostic;
  if (wanted(want::image)) files.make(want::image, [&] { return scenes::encode_png(shown); });
  if (wanted(want::linear))
    files.make(want::linear, [&] { return scenes::encode_exr(drawn.linear); });
  if (wanted(want::visibility))
    files.make(want::visibility,
               [&] { return scenes::encode_exr(drawn.visibility, drawn.light_names); });
  if (wanted(want::error_map))
    files.make(want::error_map, [&] {
      return scenes::encode_png(metrics::error_map(drawn.picture, reference.picture()));
    });
  if (wanted(want::quality)) result.quality = measure_quality(task, drawn, reference, result.notes);
  files.take(result.artefacts);
  if (along_path)
    result.quality["frame_difference"] =
        path_difference(renderer, task, change, request.earlier_cameras, parts.next());
  if (drawn.noise_rms_y) result.noise_rms_y = *drawn.noise_rms_y;
  return result;
}

}  // namespace penumbra::server
