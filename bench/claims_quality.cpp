// Whether the pictures bear out what van Sambeek 2007 found of quality:
//   bench_claims_quality [--sizes 300,600,1200] [--light-samples N] [--device NAME]
//
// rms_y of his eight techniques on the six scenes, against a reference of 1024 light points, at
// several sizes of the picture, maps of 512x512; beside his table 4.2, and judged claim by claim.
// The tables are of the second size.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "bench/program.h"
#include "bench/van_sambeek_2007.h"
#include "renderer/metrics/metrics.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "study/statistics/agreement.h"
#include "techniques/registry.h"

namespace {

using namespace penumbra;
using study::statistics::kendall_tau_b;
using study::statistics::spearman;

struct Options {
  std::vector<std::uint32_t> sizes{300, 600, 1200};
  std::uint32_t light_samples = 1024;
  std::string device;
};

bool is_volume(const std::string& id) {
  return id.find("volumes") != std::string::npos;
}

/// His eight techniques, maps first.
std::vector<std::string> subjects() {
  std::vector<std::string> list;
  for (const auto& [id, row] : published::rms_y) list.push_back(id);
  std::stable_partition(list.begin(), list.end(),
                        [](const std::string& id) { return !is_volume(id); });
  return list;
}

double mean(const std::vector<double>& row) {
  double sum = 0.0;
  for (const double value : row) sum += value;
  return sum / static_cast<double>(row.size());
}

/// Errors of one size: a row of scenes for each technique.
using Table = std::map<std::string, std::vector<double>>;

struct Measured {
  Table rms_y;
  std::vector<double> noise;  ///< the reference's own part of it, for each scene
};

Measured measure(Renderer& renderer, std::uint32_t size, std::uint32_t light_samples) {
  Measured measured;
  for (const std::string& id : published::scenes) {
    const auto scene = scenes::load(id);
    const auto render = [&](const std::string& name, bool uncertainty) {
      const auto resolved = techniques::resolve(name);
      RenderRequest request;
      request.scene = scene;
      request.technique = resolved.technique;
      request.parameters = resolved.parameters;
      request.width = request.height = size;
      request.light_samples = light_samples;
      request.uncertainty = uncertainty;
      return renderer.render(request);
    };
    const RenderResult truth = render("reference", true);
    measured.noise.push_back(truth.noise_rms_y.value_or(std::numeric_limits<double>::quiet_NaN()));
    for (const std::string& name : subjects())
      measured.rms_y[name].push_back(metrics::rms_y(render(name, false).picture, truth.picture));
    std::fprintf(stderr, "%s at %u done\n", id.c_str(), size);
  }
  return measured;
}

void print_row(const std::string& name, const std::vector<double>& row, double last) {
  std::printf("| %s |", name.c_str());
  for (const double value : row) std::printf(" %.2f |", value);
  std::printf(" %.2f |\n", last);
}

void print_table(const Measured& measured) {
  std::printf("| technique |");
  for (const std::string& scene : published::scenes) std::printf(" %s |", scene.c_str());
  std::printf(" mean |\n|---|---|---|---|---|---|---|---|\n");
  for (const std::string& name : subjects()) {
    const std::vector<double>& row = measured.rms_y.at(name);
    print_row(name, row, mean(row));
    print_row("(" + name + ")", published::rms_y.at(name), published::mean_rms_y.at(name));
  }
  print_row("noise of the reference", measured.noise, mean(measured.noise));
}

void print_claim(const char* id, const std::string& claim, const std::string& his,
                 const std::string& ours, bool reproduced) {
  std::printf("| %s | %s | %s | %s | %s |\n", id, claim.c_str(), his.c_str(), ours.c_str(),
              reproduced ? "reproduced" : "not reproduced");
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

struct Extremes {
  std::string nearest, furthest;
  double least = 1e9, most = -1e9;
};

/// Nearest and furthest of the techniques that `counts` admits, by `error` of an id.
template <class Counts, class Error_>
Extremes extremes(const Counts& counts, const Error_& error) {
  Extremes found;
  for (const std::string& id : subjects()) {
    if (!counts(id)) continue;
    const double value = error(id);
    if (value < found.least) found.nearest = id, found.least = value;
    if (value > found.most) found.furthest = id, found.most = value;
  }
  return found;
}

/// One claim about a column or the means of a table, told of both tables alike.
struct Column {
  const Table& table;
  std::size_t scene;  ///< of published::scenes; their number: the mean of all

  double operator()(const std::string& id) const {
    const std::vector<double>& row = table.at(id);
    return scene < row.size() ? row[scene] : mean(row);
  }
};

bool any(const std::string&) {
  return true;
}
bool is_map(const std::string& id) {
  return !is_volume(id);
}

std::string volumes_against_maps(const Column& column) {
  return "volumes up to " + number(extremes(is_volume, column).most) + ", maps from " +
         number(extremes(is_map, column).least);
}
bool volumes_win(const Column& column) {
  return extremes(is_volume, column).most < extremes(is_map, column).least;
}

void print_quality_claims(const Table& ours) {
  const std::size_t all = published::scenes.size();
  const auto both = [&](const char* id, const std::string& claim, std::size_t scene,
                        const auto& tell, const auto& holds) {
    const Column here{ours, scene};
    print_claim(id, claim, tell(Column{published::rms_y, scene}), tell(here), holds(here));
  };
  both("Q11", "volumes and soft volumes come nearest on the mean", all, volumes_against_maps,
       volumes_win);
  both("Q11", "and on scene 4, the island", 3, volumes_against_maps, volumes_win);
  both("Q11", "and on scene 6, before the hall", 5, volumes_against_maps, volumes_win);
  const auto best_map = [](const Column& column) {
    const Extremes found = extremes(is_map, column);
    return found.nearest + " " + number(found.least);
  };
  const auto pcss_wins = [](const Column& column) {
    return extremes(is_map, column).nearest == "pcss-nearest";
  };
  both("Q11", "percentage-closer soft shadows are the best map on scene 1, the car", 0, best_map,
       pcss_wins);
  both("Q11", "and on scene 5, in the hall", 4, best_map, pcss_wins);
  both(
      "Q11", "variance shadow maps are furthest on the mean", all,
      [](const Column& column) {
        const Extremes found = extremes(any, column);
        return found.furthest + " " + number(found.most);
      },
      [](const Column& column) { return extremes(any, column).furthest == "vsm-2007"; });
  both(
      "Q12", "on the island maps are several times as far as volumes", 3,
      [](const Column& column) {
        return "shadow-volumes " + number(column("shadow-volumes")) + ", maps " +
               number(extremes(is_map, column).least) + " to " +
               number(extremes(is_map, column).most);
      },
      [](const Column& column) {
        return extremes(is_map, column).least > 2.0 * column("shadow-volumes");
      });
}

std::vector<double> column_of(const Table& table, std::size_t scene) {
  std::vector<double> values;
  for (const std::string& id : subjects()) values.push_back(Column{table, scene}(id));
  return values;
}

/// Pairs of techniques whose order differs between two columns, with their errors in both.
std::string swaps(const Column& before, const Column& after) {
  std::string text;
  const auto list = subjects();
  for (const std::string& a : list)
    for (const std::string& b : list)
      if (before(a) < before(b) && after(a) > after(b))
        text += "; " + a + " " + number(before(a)) + " then " + number(after(a)) + ", " + b + " " +
                number(before(b)) + " then " + number(after(b));
  return text;
}

/// Kendall's tau between the orders at two sizes: of every scene, and of the means.
void print_size_claim(const Table& before, const Table& after, const std::string& sizes) {
  std::string told;
  bool same = true;
  for (std::size_t scene = 0; scene <= published::scenes.size(); ++scene) {
    const double tau = kendall_tau_b(column_of(before, scene), column_of(after, scene)).value();
    if (tau < 1.0)
      told += (scene < published::scenes.size() ? published::scenes[scene] : "mean") + ": tau " +
              number(tau) + swaps({before, scene}, {after, scene}) + ". ";
    same = same && tau == 1.0;
  }
  print_claim(
      "Q30", "the order is the same at " + sizes + " pixels a side, in every scene and on the mean",
      "not shown", same ? "tau 1 everywhere" : told + "Else tau 1", same);
}

void print_realism_claim(const Table& ours) {
  std::vector<double> his_errors, ranks;
  for (const std::string& id : subjects()) {
    his_errors.push_back(published::mean_rms_y.at(id));
    ranks.push_back(published::ranking_of(published::ranking_tables.back(), id).mean);
  }
  const double his = spearman(his_errors, ranks).value();
  const double here = spearman(column_of(ours, published::scenes.size()), ranks).value();
  char texts[2][32];
  std::snprintf(texts[0], sizeof texts[0], "%.3f", his);
  std::snprintf(texts[1], sizeof texts[1], "%.3f", here);
  print_claim("P05",
              "error and perceived realism disagree: Spearman of the mean errors of table 4.2, or "
              "ours, and the mean ranks of table 4.9",
              texts[0], texts[1], here <= 0.0);
}

void run(const Options& options) {
  Renderer renderer({options.device, false});
  std::vector<Measured> measured;
  for (const std::uint32_t size : options.sizes)
    measured.push_back(measure(renderer, size, options.light_samples));
  std::printf("Device: %s (%s). Reference of %u light samples, maps 512x512.\n\n",
              renderer.device().name.c_str(), renderer.device().driver.c_str(),
              options.light_samples);
  std::printf("rms_y, 0..255, at %ux%u; in brackets van Sambeek 2007, table 4.2:\n\n",
              options.sizes[1], options.sizes[1]);
  print_table(measured[1]);
  std::printf("\n| claim | van Sambeek 2007 | his numbers | ours | |\n|---|---|---|---|---|\n");
  print_quality_claims(measured[1].rms_y);
  for (std::size_t i = 0; i + 1 < measured.size(); ++i)
    print_size_claim(
        measured[i].rms_y, measured[i + 1].rms_y,
        std::to_string(options.sizes[i]) + " and " + std::to_string(options.sizes[i + 1]));
  print_realism_claim(measured[1].rms_y);
}

}  // namespace

int main(int count, char** values) {
  Options options;
  return penumbra::bench::run_program(
      count, values, "What van Sambeek 2007 published of quality, claim by claim",
      [&](CLI::App& app) {
        app.add_option("--sizes", options.sizes, "Pixels, two sizes at least")
            ->delimiter(',')
            ->expected(2, 100);
        app.add_option("--light-samples", options.light_samples, "Of the reference")
            ->check(CLI::PositiveNumber);
        penumbra::bench::add_device_option(app, options.device);
      },
      [&] { run(options); });
}
