// What it costs to filter a map, in several ways:
//   bench_map_filters [--repeats N] [--device NAME]
//
// A separable filter over two moments of a depth map, rows then columns: as the techniques do it,
// where an invocation filters a run of texels; with an invocation for each texel, which reads all
// from the image; and such with what a group reads kept in shared memory. Beside them a
// summed-area table of the same moments. Medians of device time, ms; the ways take turns.
// "difference" is the greatest between their results.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "bench/program.h"
#include "renderer/frame/parameter_glsl.h"
#include "renderer/shadow_maps/filters/blurred_map.h"
#include "renderer/shadow_maps/filters/summed_area.h"
#include "renderer/vulkan/commands.h"
#include "techniques/registry.h"

namespace penumbra {

std::span<const EmbeddedFile> embedded_renderer_shaders();

namespace {

/// A map whose neighbouring texels differ as in a scene of many small casters.
constexpr const char* fill_shader = R"(
layout(local_size_x = 16, local_size_y = 16) in;
uniform writeonly image2DArray target;
void main() {
  uvec2 cell = gl_GlobalInvocationID.xy / 5u;
  uint hash = (cell.x * 1664525u + cell.y * 22695477u + 1013904223u) * 747796405u;
  imageStore(target, ivec3(gl_GlobalInvocationID.xy, 0), vec4(float(hash >> 8) / 16777216.0));
}
)";

/// One direction. SHARED: a group loads what it reads once.
constexpr const char* filter_shader = R"(
#include "renderer/shaders/texel.glsl"
layout(local_size_x = 16, local_size_y = 16) in;
uniform sampler2DArray source;
uniform writeonly image2DArray target;

float weight(int offset) {
  if (parameter_blur_filter == blur_filter_box || parameter_blur == 0) return 1.0;
  float deviations = 2.0 * float(offset) / float(parameter_blur);
  return exp(-0.5 * deviations * deviations);
}

vec2 moments_at(ivec2 texel) {
  texel = clamp(texel, ivec2(0), textureSize(source, 0).xy - 1);
  vec2 value = texel_of(source, ivec3(texel, 0)).rg;
#ifdef COLUMNS
  return value;
#else
  return vec2(value.r, value.r * value.r);
#endif
}

#ifdef COLUMNS
const ivec2 direction = ivec2(0, 1);
#else
const ivec2 direction = ivec2(1, 0);
#endif

#ifdef SHARED
const int reach = 16 + 2 * parameter_blur;
shared vec2 kept[16 * reach];
#endif

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
#ifdef SHARED
  ivec2 local = ivec2(gl_LocalInvocationID.xy);
  int line = local.x * direction.y + local.y * direction.x;
  int place = local.x * direction.x + local.y * direction.y;
  for (int i = place; i < reach; i += 16)
    kept[line * reach + i] = moments_at(texel + (i - place - parameter_blur) * direction);
  barrier();
#endif
  const float share = 1.0 / float(2 * parameter_blur + 1);
  vec2 sum = vec2(0.0);
  float total = 0.0;
  for (int i = -parameter_blur; i <= parameter_blur; ++i) {
#ifdef SHARED
    vec2 value = kept[line * reach + place + parameter_blur + i];
#else
    vec2 value = moments_at(texel + i * direction);
#endif
    sum += (share * weight(i)) * value;
    total += share * weight(i);
  }
  if (all(lessThan(texel, textureSize(source, 0).xy)))
    imageStore(target, ivec3(texel, 0), vec4(sum / total, 0.0, 0.0));
}
)";

/// Greatest difference of two maps, as an integer of millionths: floats have no exact atomics.
constexpr const char* difference_shader = R"(
layout(local_size_x = 16, local_size_y = 16) in;
uniform sampler2DArray one;
uniform sampler2DArray other;
layout(std430) buffer DifferenceBlock { uint greatest; };
void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID.xy, 0);
  vec2 difference = abs(texelFetch(one, texel, 0).rg - texelFetch(other, texel, 0).rg);
  atomicMax(greatest, uint(1e6 * max(difference.r, difference.g)));
}
)";

struct Options {
  int repeats = 15;
  std::string device;
};

struct Case {
  std::uint32_t size;
  std::int64_t radius;
  std::string filter;     ///< box or gauss
  std::string precision;  ///< fp16 or fp32
};

/// Maps of one case, and the ways to filter them.
class Filters {
 public:
  Filters(vulkan::Device& device, vulkan::PipelineCache& pipelines, const Case& subject)
      : device_(device), pipelines_(pipelines), subject_(subject) {
    const bool half = subject.precision == "fp16";
    format_ = half ? VK_FORMAT_R16G16_SFLOAT : VK_FORMAT_R32G32_SFLOAT;
    depth_ = image("depth", VK_FORMAT_R32_SFLOAT);
    rows_ = image("rows", format_);
    for (vulkan::Image& result : results_) result = image("result", format_);
    table_ = vulkan::Buffer(device, ledger_, "table", VkDeviceSize{8} * subject.size * subject.size,
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    difference_ = vulkan::Buffer(device, ledger_, "difference", 16,
                                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, vulkan::MemoryKind::readback);
    const ParameterValues blur{{"blur", subject.radius}, {"blur_filter", subject.filter}};
    declarations_ = declarations(shadow_maps::blur_parameters(), blur);
    table_declarations_ =
        declarations(shadow_maps::summed_area_parameters(), {{"table", std::string("fp32")}});
  }

  void fill(vulkan::Recorder& recorder) {
    vulkan::Bindings bindings;
    bindings.storage_image("target", depth_);
    recorder.pass("fill", [&](vulkan::Commands& commands) {
      commands.bind(pipelines_.compute("bench/fill.comp"), bindings);
      dispatch(commands);
    });
  }

  void record(vulkan::Recorder& recorder) {
    recorder.pass("runs", [&](vulkan::Commands& commands) {
      filter_runs(commands, shadow_maps::encoding("techniques/vsm/encoder.glsl"), "depths", depth_,
                  rows_);
      commands.barrier();
      filter_runs(commands, "", "blurred_rows", rows_, results_[0]);
    });
    recorder.pass("texels",
                  [&](vulkan::Commands& commands) { compute(commands, "", results_[1]); });
    recorder.pass("texels, shared", [&](vulkan::Commands& commands) {
      compute(commands, "#define SHARED\n", results_[2]);
    });
    recorder.pass("summed area", [&](vulkan::Commands& commands) { sum(commands); });
  }

  /// Greatest difference between the result of runs and the others.
  double difference(vulkan::Recorder& recorder) {
    std::memset(difference_.mapped(), 0, 16);
    for (const int other : {1, 2}) {
      vulkan::Bindings bindings;
      bindings.texture("one", results_[0], vulkan::Sampling::nearest);
      bindings.texture("other", results_[other], vulkan::Sampling::nearest);
      bindings.buffer("DifferenceBlock", difference_.whole());
      recorder.pass("compare", [&, bindings](vulkan::Commands& commands) {
        commands.bind(pipelines_.compute("bench/difference.comp"), bindings);
        dispatch(commands);
      });
    }
    recorder.flush();
    std::uint32_t millionths = 0;
    std::memcpy(&millionths, difference_.mapped(), sizeof millionths);
    return 1e-6 * millionths;
  }

 private:
  vulkan::Image image(const char* name, VkFormat format) {
    vulkan::ImageDescription description;
    description.format = format;
    description.width = description.height = subject_.size;
    description.array_view = true;
    description.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
    return vulkan::Image(device_, ledger_, name, description);
  }

  static std::string declarations(const std::vector<Parameter>& declared,
                                  const ParameterValues& values) {
    return parameter_declarations(declared, complete_parameters(declared, values));
  }

  void dispatch(vulkan::Commands& commands) const {
    const std::uint32_t groups = (subject_.size + 15) / 16;
    commands.dispatch(groups, groups);
  }

  void filter_runs(vulkan::Commands& commands, const std::string& encoding, const char* name,
                   const vulkan::Image& source, const vulkan::Image& target) {
    vulkan::Bindings bindings;
    bindings.texture_slice(name, source, 0, 0, vulkan::Sampling::nearest);
    bindings.storage_slice("filtered_map", target, 0);
    commands.bind(
        pipelines_.compute(shadow_maps::blur_program,
                           declarations_ + shadow_maps::blur_definitions(format_) + encoding),
        bindings);
    shadow_maps::dispatch_blur(commands, subject_.size);
  }

  void compute(vulkan::Commands& commands, const std::string& way, const vulkan::Image& result) {
    const auto run = [&](const std::string& own, const vulkan::Image& source,
                         const vulkan::Image& target) {
      vulkan::Bindings bindings;
      bindings.texture("source", source, vulkan::Sampling::nearest);
      bindings.storage_image("target", target);
      commands.bind(pipelines_.compute("bench/filter.comp", declarations_ + way + own), bindings);
      dispatch(commands);
    };
    run("", depth_, rows_);
    commands.barrier();
    run("#define COLUMNS\n", rows_, result);
  }

  void sum(vulkan::Commands& commands) {
    vulkan::Bindings bindings;
    bindings.buffer("SummedAreaBlock", table_.whole());
    bindings.texture("shadow_map", depth_, vulkan::Sampling::nearest);
    for (const char* own : {"", "#define COLUMNS\n"}) {
      commands.bind(pipelines_.compute("renderer/shadow_maps/filters/summed_area.comp",
                                       table_declarations_ + own),
                    bindings);
      commands.constants(static_cast<std::int32_t>(subject_.size));
      commands.dispatch((subject_.size + 7) / 8, 1);
      commands.barrier();
    }
  }

  vulkan::Device& device_;
  vulkan::PipelineCache& pipelines_;
  Case subject_;
  VkFormat format_ = VK_FORMAT_UNDEFINED;
  vulkan::MemoryLedger ledger_;
  vulkan::Image depth_, rows_, results_[3];
  vulkan::Buffer table_, difference_;
  std::string declarations_, table_declarations_;
};

void print_row(vulkan::Device& device, vulkan::PipelineCache& pipelines, const Case& subject,
               int repeats) {
  vulkan::Recorder recorder(device, pipelines);
  Filters filters(device, pipelines, subject);
  recorder.begin(false);
  filters.fill(recorder);
  filters.record(recorder);  // compiles, and warms caches
  const double difference = filters.difference(recorder);
  recorder.end();
  std::map<std::string, std::vector<double>> times;
  for (int i = 0; i < repeats; ++i) {
    recorder.clear_records();
    recorder.begin(false);
    filters.record(recorder);
    recorder.end();
    for (const vulkan::PassRecord& record : recorder.records())
      times[record.name].push_back(record.ms);
  }
  const double runs = penumbra::bench::median(times.at("runs"));
  const double texels = penumbra::bench::median(times.at("texels"));
  const double shared = penumbra::bench::median(times.at("texels, shared"));
  std::printf("| %u | %s | %s | %lld | %.3g | %.3g | %.3g | %.2f | %.3g | %.1e |\n", subject.size,
              subject.precision.c_str(), subject.filter.c_str(),
              static_cast<long long>(subject.radius), runs, texels, shared,
              runs / std::min(texels, shared), penumbra::bench::median(times.at("summed area")),
              difference);
  std::fflush(stdout);
}

void run(const Options& options) {
  vulkan::Device device({options.device, false});
  vulkan::ShaderLibrary library;
  library.add(embedded_renderer_shaders());
  library.add(techniques::resolve("vsm").technique->files);
  library.add("bench/fill.comp", fill_shader);
  library.add("bench/filter.comp", filter_shader);
  library.add("bench/difference.comp", difference_shader);
  vulkan::PipelineCache pipelines(device, library);
  std::printf("Device: %s (%s). Medians of %d, ms.\n\n", device.info.name.c_str(),
              device.info.driver.c_str(), options.repeats);
  std::printf(
      "| map | format | filter | radius | runs | texels | texels, shared | runs / better texels | "
      "summed area | difference |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::uint32_t size : {512u, 1024u})
    for (const char* precision : {"fp16", "fp32"})
      for (const char* filter : {"box", "gauss"})
        for (const std::int64_t radius : {1, 4, 16})
          print_row(device, pipelines, {size, radius, filter, precision}, options.repeats);
}

}  // namespace
}  // namespace penumbra

int main(int count, char** values) {
  penumbra::Options options;
  return penumbra::bench::run_program(
      count, values, "Ways to filter a map, in turns",
      [&](CLI::App& app) {
        app.add_option("--repeats", options.repeats, "Times that each way is taken")
            ->check(CLI::PositiveNumber);
        penumbra::bench::add_device_option(app, options.device);
      },
      [&] { penumbra::run(options); });
}
