#include "renderer/frame/picture_run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "renderer/frame/archive.h"
#include "renderer/frame/common_parameters.h"
#include "renderer/frame/host_copy.h"
#include "renderer/frame/rounds.h"

namespace penumbra {
namespace {

/// Copies a window's pixels, `scale` by `scale` of them for each of the picture's, to their place.
template <class T>
void paste(Image<T>& whole, const Image<T>& part, const Window& window,
           const RenderRequest& request, std::uint32_t scale = 1) {
  if (part.empty()) return;
  if (whole.empty()) whole = Image<T>(request.width * scale, request.height * scale, part.channels);
  const std::size_t row = std::size_t{part.width} * part.channels;
  for (std::uint32_t y = 0; y < part.height; ++y)
    std::copy_n(part.pixels.begin() + static_cast<std::ptrdiff_t>(y * row), row,
                &whole.at(window.x * scale, window.y * scale + y, 0));
}

/// Returns how many pixels were not: those that are no numbers, see encoding.glsl.
std::uint64_t make_opaque(Image8& picture) {
  std::uint64_t found = 0;
  for (std::size_t alpha = 3; alpha < picture.pixels.size(); alpha += 4)
    if (picture.pixels[alpha] == 0) {
      picture.pixels[alpha] = 255;
      ++found;
    }
  return found;
}

std::string in_levels(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", value);
  return text;
}

}  // namespace

template <class Archive>
void PictureRun::Progress::visit(Archive& archive) {
  archive(window);
  archive(round);
  archive(light_samples);
  archive(non_finite_pixels);
  archive(picture);
  archive(diagnostic);
  archive(linear);
  archive(visibility);
  archive(judged);
  archive(uncertainty);
  archive(points);
  sum.visit(archive);
}

PictureRun::PictureRun(Renderer::State& state, const RenderRequest& request,
                       const ParameterValues& parameters, const RenderControl& control)
    : state_(state),
      request_(request),
      parameters_(parameters),
      control_(control),
      windows_(cover(request.width, request.height, samples_per_side(request.supersampling),
                     state.most_window_samples,
                     state.device.properties.limits.maxImageDimension2D)),
      rounds_(rounds_of(request.light_samples, request.error_bound > 0.0)),
      frame_(state, request, parameters, windows_.front(), rounds_.size() > 1) {
  goes_through_points_ =
      std::any_of(frame_.lights().begin(), frame_.lights().end(), [&](const auto& light) {
        return light && light->needs().light_points == request.light_samples;
      });
  // Nothing changes from round to round where no pass goes through the picture's points.
  if (!goes_through_points_) rounds_ = {{0, request.light_samples}};
}

RenderResult PictureRun::run() {
  // One frame alone is both warm-up and picture; with more, the first is drawn to compile shaders
  // and to count, and the others are timed without counters.
  const std::uint32_t warm_up = request_.frames > 1 ? 1 : 0;
  frames_total_ = warm_up + request_.frames;
  double create_ms = 0.0;
  draw_earlier_cameras();
  take_up();
  bool settled = true;
  for (; frame_index_ < frames_total_; ++frame_index_) {
    if (frame_index_ == warm_up) settled = wait_for_clocks();
    if (frame_index_ > 0) now_ = {};
    state_.recorder.clear_records();
    draw_frame(frame_index_);
    costs_.add(state_.recorder.records(), state_.recorder.wall_ms(), frame_index_ >= warm_up);
    if (frame_index_ == 0)
      create_ms =
          std::chrono::duration<double, std::milli>(Clock::now() - start_).count() - settling_ms_;
  }
  if (tells_clocks()) settled = settled && state_.yardstick.clocks_are_up(state_);
  if (follows_path()) hand_over(std::move(now_.points), now_.visibility, now_.judged);
  RenderResult result;
  result.cost = costs_.summary();
  result.cost.settled = settled;
  result.cost.settling_ms = settling_ms_;
  result.cost.create_ms = create_ms;
  result.cost.technique_memory = frame_.technique_memory();
  result.picture = std::move(now_.picture);
  result.diagnostic = std::move(now_.diagnostic);
  if (request_.linear) result.linear = std::move(now_.linear);
  result.visibility = std::move(now_.visibility);
  result.judged = std::move(now_.judged);
  if (!now_.uncertainty.empty()) {
    result.noise_rms_y = root_mean_square(now_.uncertainty);
    result.uncertainty = std::move(now_.uncertainty);
  }
  result.light_samples = now_.light_samples;
  for (const auto& light : request_.scene->lights) result.light_names.push_back(light.name);
  result.non_finite_pixels = now_.non_finite_pixels;
  add_notes(result);
  state_.device.throw_if_validation_failed();
  return result;
}

void PictureRun::draw_earlier_cameras() {
  if (request_.earlier_cameras.empty()) return;
  const Scene& scene = *request_.scene;
  const Camera& own = scene.cameras[find_camera(scene, request_.camera)];
  // What the first counted frame counts is the picture's alone.
  constexpr std::uint32_t not_counted = 1;
  for (const Camera& camera : request_.earlier_cameras) {
    frame_.look_through(camera);
    ImageF points, visibility, judged;
    for (const Window& window : windows_) {
      state_.recorder.clear_records();
      frame_.draw(window, rounds_.front(), not_counted, false, {});
      if (!follows_path()) continue;
      ImageF seen, facing;
      read_visibility(seen, facing);
      paste(visibility, seen, window, request_);
      paste(judged, facing, window, request_);
      read_points(window, points);
    }
    if (follows_path()) hand_over(std::move(points), std::move(visibility), std::move(judged));
    ++cameras_done_;
    report(0.0);
  }
  frame_.look_through(own);
}

bool PictureRun::tells_clocks() const {
  // A processor has no clocks that fall while it waits for the next picture.
  return request_.settle && state_.device.info.type != "cpu";
}

bool PictureRun::wait_for_clocks() {
  if (!tells_clocks()) return true;
  const Clock::time_point start = Clock::now();
  const bool up = state_.yardstick.raise_clocks(state_);
  settling_ms_ = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  return up;
}

void PictureRun::draw_frame(std::uint32_t index) {
  while (now_.window < windows_.size()) {
    const Window& window = windows_[now_.window];
    if (now_.round == 0 && frame_.uncertainty() != nullptr) frame_.uncertainty()->restart();
    do {
      if (now_.round > 0) between_parts();
      draw_round(window, index);
    } while (!window_is_done());
    finish_window(window);
    if (now_.window < windows_.size()) between_parts();
  }
}

void PictureRun::draw_round(const Window& window, std::uint32_t index) {
  const PointRange round = rounds_[now_.round];
  frame_.draw(window, round, index, index == 0, [&](double share) { report(share); });
  if (rounds_.size() > 1) {
    ImageF visibility, judged;
    read_visibility(visibility, judged);
    now_.sum.add(read_float(state_.device, frame_.targets().linear, 4), visibility, judged,
                 round.count);
  }
  ++now_.round;
  now_.light_samples = std::max(now_.light_samples, round.first + round.count);
  report(0.0);
}

bool PictureRun::window_is_done() const {
  if (now_.round == rounds_.size()) return true;
  if (request_.error_bound <= 0.0 || frame_.uncertainty() == nullptr) return false;
  return root_mean_square(standard_error(now_.sum.linear())) <= request_.error_bound;
}

void PictureRun::finish_window(const Window& window) {
  const FrameTargets& targets = frame_.targets();
  ++now_.window;
  now_.round = 0;
  if (frame_index_ + 1 < frames_total_) {
    // The frame is only timed: the last one's picture is the result.
    if (rounds_.size() > 1) now_.sum.restart();
    return;
  }
  ImageF linear, visibility, judged;
  if (rounds_.size() > 1) {
    linear = now_.sum.linear();
    visibility = now_.sum.visibility();
    judged = now_.sum.judged();
    frame_.encode(linear);
    now_.sum.restart();
  } else {
    if (targets.linear) linear = read_float(state_.device, targets.linear, 4);
    read_visibility(visibility, judged);
  }
  Image8 picture = read_rgba8(state_.device, targets.picture);
  now_.non_finite_pixels += make_opaque(picture);
  paste(now_.picture, picture, window, request_);
  paste(now_.linear, linear, window, request_);
  paste(now_.visibility, visibility, window, request_);
  paste(now_.judged, judged, window, request_);
  read_points(window, now_.points);
  if (frame_.uncertainty() != nullptr)
    paste(now_.uncertainty, standard_error(linear), window, request_);
  if (targets.diagnostic)
    paste(now_.diagnostic, read_rgba8(state_.device, targets.diagnostic), window, request_,
          samples_per_side(request_.supersampling));
}

ImageF PictureRun::standard_error(const ImageF& linear) const {
  return frame_.uncertainty()->standard_error(linear, exposure_factor(request_),
                                              gamma_treatment(parameters_).encodes);
}

void PictureRun::read_visibility(ImageF& visibility, ImageF& judged) const {
  const vulkan::Image& image = frame_.targets().visibility;
  if (!image) return;
  const std::uint32_t lights = image.description().layers;
  judged = ImageF(image.description().width, image.description().height, lights);
  visibility = ImageF(judged.width, judged.height, lights, 1.0f);
  for (std::uint32_t i = 0; i < lights; ++i) {
    // One that reaches no pixel: visible where not judged, judged nowhere.
    if (!frame_.lights()[i]) continue;
    const ImageF pair = read_float(state_.device, image, 2, i);
    for (std::size_t p = 0; p < pair.pixel_count(); ++p) {
      visibility.pixels[p * lights + i] = pair.pixels[2 * p];
      judged.pixels[p * lights + i] = pair.pixels[2 * p + 1];
    }
  }
}

void PictureRun::read_points(const Window& window, ImageF& points) const {
  if (!follows_path()) return;
  const ImageF samples = read_float(state_.device, frame_.targets().geometry.position, 4);
  const std::uint32_t side = samples_per_side(request_.supersampling);
  ImageF part(window.width, window.height, 4);
  for (std::uint32_t y = 0; y < part.height; ++y)
    for (std::uint32_t x = 0; x < part.width; ++x)
      std::copy_n(&samples.at(side * x + side / 2, side * y + side / 2, 0), 4, &part.at(x, y, 0));
  paste(points, part, window, request_);
}

void PictureRun::hand_over(ImageF points, ImageF visibility, ImageF judged) const {
  const double side = samples_per_side(request_.supersampling);
  const double sample = (std::floor(0.5 * side) + 0.5) / side;
  control_.path_frame({std::move(points), sample, std::move(visibility), std::move(judged),
                       frame_.picture_camera().clip_from_world});
}

void PictureRun::report(double share_of_round) const {
  if (!control_.progress) return;
  double points = 0.0;
  if (now_.round < rounds_.size()) {
    const PointRange& round = rounds_[now_.round];
    points = (round.first + share_of_round * round.count) / request_.light_samples;
  } else {
    points = 1.0;
  }
  const double windows = (now_.window + points) / static_cast<double>(windows_.size());
  control_.progress((static_cast<double>(cameras_done_) + frame_index_ + windows) /
                    static_cast<double>(request_.earlier_cameras.size() + frames_total_));
}

void PictureRun::between_parts() {
  if (frames_total_ == 1 && control_.between_parts)
    control_.between_parts([this] { return state(); });
}

/// Differs where a kept state cannot be this picture's: the caller knows the request, this the
/// rest.
std::uint64_t PictureRun::signature() const {
  std::uint64_t hash = 14695981039346656037ull;  // FNV-1a
  const auto mix = [&](std::uint64_t value) { hash = (hash ^ value) * 1099511628211ull; };
  const DeviceInfo& device = state_.device.info;
  for (const char c : renderer_version() + device.name + device.driver)
    mix(static_cast<unsigned char>(c));
  mix(request_.width);
  mix(request_.height);
  mix(request_.supersampling);
  mix(windows_.size());
  for (const PointRange& round : rounds_) mix(round.count);
  mix(frame_.lights().size());
  mix(frame_.uncertainty() != nullptr);
  mix((request_.linear ? 1u : 0u) + (request_.visibility ? 2u : 0u) + (follows_path() ? 4u : 0u));
  return hash;
}

std::string PictureRun::state() {
  ArchiveWriter archive;
  archive(signature());
  now_.visit(archive);
  if (frame_.uncertainty() != nullptr) frame_.uncertainty()->visit(archive);
  return std::move(archive.bytes);
}

void PictureRun::take_up() {
  if (control_.resume.empty() || frames_total_ > 1) return;
  try {
    ArchiveReader archive(control_.resume);
    std::uint64_t of = 0;
    archive(of);
    if (of != signature()) return;
    Progress progress;
    progress.visit(archive);
    if (progress.window >= windows_.size() || progress.round >= rounds_.size()) return;
    if (frame_.uncertainty() != nullptr) frame_.uncertainty()->visit(archive);
    if (!archive.at_end()) throw std::runtime_error("archive goes on");
    now_ = std::move(progress);
    const double points = rounds_[now_.round].first / static_cast<double>(request_.light_samples);
    taken_up_at_ = (now_.window + points) / static_cast<double>(windows_.size());
  } catch (const std::runtime_error&) {
    now_ = {};
  }
}

void PictureRun::add_notes(RenderResult& result) const {
  result.notes = frame_.notes();
  if (taken_up_at_ > 0.0)
    result.notes.push_back("taken up again at " + in_levels(100.0 * taken_up_at_) + "%");
  if (result.non_finite_pixels > 0)
    result.notes.push_back(std::to_string(result.non_finite_pixels) +
                           " pixels are not finite and shown in magenta");
  if (request_.error_bound <= 0.0 || !result.noise_rms_y || !goes_through_points_) return;
  const std::string error = "an error of " + in_levels(*result.noise_rms_y) + " levels, ";
  const std::string bound = " the bound of " + in_levels(request_.error_bound);
  if (*result.noise_rms_y > request_.error_bound)
    result.notes.push_back("all " + std::to_string(request_.light_samples) +
                           " light points leave " + error + "above" + bound);
  else
    result.notes.push_back(std::to_string(result.light_samples) + " of " +
                           std::to_string(request_.light_samples) + " light points leave " + error +
                           "within" + bound);
}

}  // namespace penumbra
