// Claims about depth maps, and about techniques that are neither maps nor volumes.
#include <algorithm>
#include <cmath>
#include <string>

#include "experiments/claims/claim.h"
#include "experiments/claims/laboratory.h"
#include "experiments/sweep/limits.h"
#include "renderer/metrics/metrics.h"

namespace penumbra::experiments::claims {
namespace {

double hard_value(Laboratory& lab, const char* key, const std::string& scene,
                  const std::string& technique) {
  return lab.value(key, scene, technique, Truth::hard);
}

Outcome q07(Laboratory& lab) {
  const std::string map = "shadow-map:bias_strategy=constant:slope_scale=0:bias=";
  Outcome outcome;
  std::vector<double> acne, detached, rms;
  for (const char* bias : {"0", "0.002", "0.01", "0.05", "0.2"}) {
    acne.push_back(hard_value(lab, "false_shadow", "contact", map + bias));
    detached.push_back(hard_value(lab, "missing_shadow", "contact", map + bias));
    rms.push_back(hard_value(lab, "visibility_rms", "contact", map + bias));
    outcome.number(std::string("false_shadow, bias ") + bias, acne.back());
    outcome.number(std::string("missing_shadow, bias ") + bias, detached.back());
  }
  const double back = hard_value(lab, "false_shadow", "contact",
                                 "shadow-map:bias_strategy=back-faces:slope_scale=0");
  outcome.number("false_shadow of back faces", back);
  outcome.part(std::is_sorted(acne.rbegin(), acne.rend()) && acne.back() < acne.front());
  outcome.part(std::is_sorted(detached.begin(), detached.end()) &&
               detached.back() > detached.front());
  const auto least = std::min_element(rms.begin(), rms.end());
  outcome.part(least != rms.begin() && least + 1 != rms.end());
  outcome.part(back < 0.25 * acne.front());
  return outcome;
}

Outcome q08(Laboratory& lab) {
  const std::string map =
      "shadow-map:depth_bits=16:near=0.1:bias_strategy=constant:slope_scale=0:bias=0.02:depth=";
  const double linear = hard_value(lab, "false_shadow", "boxes", map + "linear");
  const double hyperbolic = hard_value(lab, "false_shadow", "boxes", map + "hyperbolic");
  Outcome outcome;
  outcome.number("false_shadow, linear", linear);
  outcome.number("false_shadow, 1/z", hyperbolic);
  outcome.part(linear < hyperbolic);
  return outcome;
}

Outcome q09(Laboratory& lab) {
  const std::string map =
      "shadow-map:depth_bits=16:depth=hyperbolic:bias_strategy=constant:slope_scale=0:bias=0.02";
  const double fitted = hard_value(lab, "visibility_rms", "boxes", map);
  const double fixed = hard_value(lab, "visibility_rms", "boxes", map + ":near=0.1:far=1000");
  Outcome outcome;
  outcome.number("visibility_rms, fitted", fitted);
  outcome.number("near 0.1 m, far 1000 m", fixed);
  outcome.part(fitted < fixed);
  return outcome;
}

/// Width in metres of half-plane's penumbra, from where its middle row passes 0.1 and 0.9.
double penumbra_width(const RenderResult& drawn) {
  const std::uint32_t row = drawn.visibility.height / 2;
  std::uint32_t between = 0;
  for (std::uint32_t x = 0; x < drawn.visibility.width; ++x) {
    const float value = drawn.visibility.at(x, row, 0);
    if (drawn.judged.at(x, row, 0) > 0.5f && value > 0.1f && value < 0.9f) ++between;
  }
  // The camera looks down from 0.8 m with 60 degrees.
  const double seen = 2.0 * 0.8 * std::tan(std::acos(-1.0) / 6.0);
  return seen * between / drawn.visibility.width / 0.8;
}

Outcome q10(Laboratory& lab) {
  // A light 1 m wide at 4 m, an edge at 1 m: (4 - 3) 1 / 3 m.
  constexpr double expected = 1.0 / 3.0;
  Outcome outcome;
  for (const char* technique : {"reference", "pcss:map_size=1024"}) {
    const double width = penumbra_width(lab.draw("half-plane", technique));
    outcome.number(std::string("metres, ") + technique, width);
    outcome.part(std::abs(width / expected - 1.0) < 0.15);
  }
  return outcome;
}

double mean_level(const RenderResult& drawn) {
  double sum = 0.0;
  const Image8& picture = drawn.picture;
  for (std::uint32_t y = 0; y < picture.height; ++y)
    for (std::uint32_t x = 0; x < picture.width; ++x)
      sum +=
          0.299 * picture.at(x, y, 0) + 0.587 * picture.at(x, y, 1) + 0.114 * picture.at(x, y, 2);
  return sum / static_cast<double>(picture.pixel_count());
}

Outcome q21(Laboratory& lab) {
  const auto level = [&](const std::string& gamma) {
    return mean_level(lab.draw("car", "none:gamma=" + gamma));
  };
  const double right = level("correct"), dark = level("input_only"), bright = level("output_only");
  const double twice = level("textures_encoded_twice");
  Outcome outcome;
  outcome.number("correct", right);
  outcome.number("never encoded", dark);
  outcome.number("never decoded", bright);
  outcome.number("textures not decoded", twice);
  outcome.part(dark < right);
  outcome.part(bright > right);
  outcome.part(twice > right);
  outcome.note = "mean luma, 0 to 255";
  return outcome;
}

Outcome q24(Laboratory& lab) {
  const auto number = [&](Outcome& outcome, const char* key, const char* scene, const char* id) {
    const double value = hard_value(lab, key, scene, id);
    outcome.number(std::string(key) + ", " + scene + ", " + id, value);
    return value;
  };
  Outcome outcome;
  const double acne = number(outcome, "false_shadow", "aircraft", "occluder-textures");
  outcome.part(acne <= number(outcome, "false_shadow", "aircraft", "shadow-map"));
  const double missing = number(outcome, "missing_shadow", "teapot", "occluder-textures");
  outcome.part(missing > 2.0 * number(outcome, "missing_shadow", "teapot", "shadow-map"));
  return outcome;
}

Outcome q25(Laboratory& lab) {
  const double with = hard_value(lab, "false_shadow", "aircraft", "occluder-textures");
  const double without =
      hard_value(lab, "false_shadow", "aircraft", "occluder-textures:sign_test=false");
  Outcome outcome;
  outcome.number("false_shadow with the test", with);
  outcome.number("without", without);
  outcome.part(without > 2.0 * with);
  return outcome;
}

/// Root mean square error of visibility on the ground and elsewhere: a pixel shows the ground where
/// it does not change without all other things.
std::pair<double, double> errors_on_and_off_the_ground(Laboratory& lab, const std::string& scene,
                                                       const std::string& technique) {
  Scene bare = *lab.engine().scene(scene);
  std::erase_if(bare.instances, [](const Instance& i) { return i.name != "ground"; });
  const RenderResult drawn = lab.draw(scene, technique), truth = lab.draw(scene, "ray-traced");
  const Image8 all = lab.draw(scene, "none").picture;
  const Image8 ground =
      lab.draw(std::make_shared<const Scene>(std::move(bare)), "ground alone", "none").picture;
  double sums[2] = {}, counts[2] = {};
  for (std::size_t i = 0; i < all.pixel_count(); ++i) {
    if (truth.judged.pixels[i] == 0.0f) continue;
    const std::size_t first = i * all.channels;
    const bool elsewhere =
        !std::equal(&all.pixels[first], &all.pixels[first] + all.channels, &ground.pixels[first]);
    const double error = drawn.visibility.pixels[i] - truth.visibility.pixels[i];
    sums[elsewhere] += error * error;
    counts[elsewhere] += 1.0;
  }
  return {std::sqrt(sums[0] / counts[0]), std::sqrt(sums[1] / counts[1])};
}

Outcome q28(Laboratory& lab) {
  const auto [on, off] = errors_on_and_off_the_ground(lab, "boxes", "projected");
  Outcome outcome;
  outcome.number("visibility_rms on the plane", on);
  outcome.number("elsewhere", off);
  outcome.part(on < 0.02);
  outcome.part(off > 0.02);
  return outcome;
}

/// Root mean square error of a reference of few samples, over seeds: all pixels share its points,
/// so that one draw tells little.
double error_of_samples(Laboratory& lab, const std::string& sampling, std::uint32_t samples,
                        std::uint32_t size, const RenderResult& truth) {
  Run run;
  run.scene = "half-plane";
  run.technique = "reference";
  run.parameters = read_technique("reference:sampling=" + sampling).parameters;
  run.width = run.height = size;
  run.light_samples = samples;
  RenderRequest request = lab.engine().request_of(run);
  request.visibility = true;
  constexpr std::uint64_t seeds = 16;
  double sum = 0.0;
  for (request.seed = 1; request.seed <= seeds; ++request.seed) {
    if (lab.before) lab.before(sampling + " " + std::to_string(samples));
    const RenderResult drawn = lab.engine().renderer().render(request);
    const double rms =
        metrics::visibility_error(drawn.visibility, truth.visibility, truth.judged).rms;
    sum += rms * rms;
  }
  return std::sqrt(sum / static_cast<double>(seeds));
}

Outcome q29(Laboratory& lab) {
  const std::uint32_t size = std::min(lab.scale().size, 60u);
  const RenderResult truth = lab.draw("half-plane", "reference", size, 65536);
  Outcome outcome;
  double slopes[2] = {};
  int i = 0;
  for (const char* sampling : {"random", "low-discrepancy"}) {
    std::vector<std::pair<double, double>> points;
    for (const std::uint32_t samples : {16u, 64u, 256u, 1024u, 4096u}) {
      const double rms = error_of_samples(lab, sampling, samples, size, truth);
      outcome.number(std::string(sampling) + " " + std::to_string(samples), rms);
      points.emplace_back(samples, rms);
    }
    slopes[i] = exponent(points).value_or(0.0);
    outcome.number(std::string("exponent, ") + sampling, slopes[i]);
    ++i;
  }
  outcome.part(std::abs(slopes[0] + 0.5) < 0.1);
  outcome.part(slopes[1] < slopes[0] - 0.1);
  return outcome;
}

}  // namespace

std::vector<Claim> map_claims() {
  return {
      {"Q07", "S0 2.2.2, S4 fig. 10",
       "acne without bias, detached shadows with too much; back faces remove acne",
       "on contact false_shadow falls with bias; missing_shadow rises; the least error lies "
       "between; back faces have below a quarter of the acne",
       q07},
      {"Q08", "S0 2.2.2", "linear depth beats 1/z far from the light at equal bits",
       "at 16 bits and near 0.1 m linear has less false_shadow on boxes", q08},
      {"Q09", "S0 2.2.3, S4 fig. 9", "a fitted depth range beats a fixed one",
       "at 16 bits 1/z and equal bias its error on boxes is less", q09},
      {"Q10", "S0 2.2.5", "PCSS's penumbrae are (dR - dB) w / dB wide",
       "the reference's width on half-plane within 15% of 1/3 m; PCSS's", q10},
      {"Q21", "S3 A.5", "uncorrected output is too dark, undecoded input too bright",
       "mean luma of car below the correct one; above it; above it with only textures undecoded",
       q21},
      {"Q24", "S2 6.1", "occluder textures have no acne on flat parts; round ones miss shadows",
       "aircraft: false_shadow no more than the map's; teapot: missing_shadow over twice the map's",
       q24},
      {"Q25", "S2 4.1", "without the sign test occluder textures cast false shadows",
       "false_shadow on aircraft over twice that with it", q25},
      {"Q28", "S0 2.3", "projected shadows match the truth on their plane only",
       "visibility_rms against exact rays on the ground of boxes below 0.02; elsewhere above", q28},
      {"Q29", "S0 4.1.2", "random references converge as N^-1/2, ours faster",
       "from 16 to 4096 samples, over 16 seeds: exponent of random within 0.1 of -0.5; ours "
       "steeper by 0.1 at least",
       q29},
  };
}

}  // namespace penumbra::experiments::claims
