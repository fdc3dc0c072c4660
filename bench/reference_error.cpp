// Error of the reference against the number of its light samples, at a penumbra that is known in
// closed form, for both ways to choose points; and what the reference itself says of it. Prints a
// table, and draws it where a file is named.
//
//   bench_reference_error [FIGURE.svg]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "bench/program.h"
#include "renderer/error.h"
#include "renderer/render.h"
#include "scenes/library.h"
#include "techniques/registry.h"

namespace penumbra {
namespace {

constexpr std::uint32_t size = 48;
constexpr std::uint64_t seeds = 8;

struct Row {
  std::uint32_t samples;
  double even, random;  ///< root mean square errors of visibility in the penumbra
};

/// Share of the square light that is seen from x on the plane of the scene half-plane: its plate
/// fills x < 0 between the heights 0.9995 and 1.0005 m, the light is 1 m wide and 4 m high.
double truth_at(std::uint32_t column) {
  const double half = 0.8 * std::tan(std::acos(-1.0) / 6.0);
  const double x = half * (2.0 * (column + 0.5) / size - 1.0);
  return std::clamp(0.5 - std::max(x * (1.0 - 4.0 / 0.9995), x * (1.0 - 4.0 / 1.0005)), 0.0, 1.0);
}

double error_of(Renderer& renderer, const char* sampling, std::uint32_t samples) {
  const auto resolved = techniques::resolve("reference", {{"sampling", std::string(sampling)}});
  RenderRequest request;
  request.scene = scenes::load("half-plane");
  request.technique = resolved.technique;
  request.parameters = resolved.parameters;
  request.width = request.height = size;
  request.light_samples = samples;
  request.visibility = true;
  double squares = 0.0;
  int count = 0;
  for (request.seed = 1; request.seed <= seeds; ++request.seed) {
    const RenderResult result = renderer.render(request);
    for (std::uint32_t column = 0; column < size; ++column) {
      const double truth = truth_at(column);
      if (truth <= 0.0 || truth >= 1.0) continue;
      squares +=
          std::pow(static_cast<double>(result.visibility.at(column, size / 2, 0)) - truth, 2.0);
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

/// Places on a figure of 520 x 360: a decade of samples is 160 wide, one of errors 70 high.
double across(double samples) {
  return 60.0 + 160.0 * (std::log10(samples) - 1.0);
}
double down(double error) {
  return 20.0 - 70.0 * std::log10(error);
}

void draw_line(std::ofstream& out, const std::vector<Row>& rows, double Row::*column,
               const char* color, const char* label) {
  out << "<polyline fill=\"none\" stroke=\"" << color << "\" stroke-width=\"2\" points=\"";
  for (const Row& row : rows) out << across(row.samples) << ',' << down(row.*column) << ' ';
  out << "\"/>\n<text x=\"" << across(rows.back().samples) + 6 << "\" y=\""
      << down(rows.back().*column) + 4 << "\" fill=\"" << color << "\">" << label << "</text>\n";
}

void draw(const std::string& file, const std::vector<Row>& rows) {
  std::ofstream out(file);
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 600 350\" "
         "font-family=\"sans-serif\" font-size=\"12\">\n<title>Error against light "
         "samples</title>\n"
         "<rect width=\"600\" height=\"350\" fill=\"white\"/>\n";
  for (const int samples : {10, 100, 1000, 10000})
    out << "<path stroke=\"#ddd\" d=\"M" << across(samples) << " 20V300\"/><text x=\""
        << across(samples) << "\" y=\"316\" text-anchor=\"middle\">" << samples << "</text>\n";
  for (const char* error : {"1", "0.1", "0.01", "0.001", "0.0001"})
    out << "<path stroke=\"#ddd\" d=\"M60 " << down(std::atof(error))
        << "H540\"/><text x=\"54\" y=\"" << down(std::atof(error)) + 4 << "\" text-anchor=\"end\">"
        << error << "</text>\n";
  out << "<text x=\"300\" y=\"338\" text-anchor=\"middle\">light samples</text>\n"
         "<text x=\"70\" y=\"14\">rms error of visibility in the penumbra</text>\n";
  draw_line(out, rows, &Row::random, "#b5482a", "random");
  draw_line(out, rows, &Row::even, "#2a5db0", "low-discrepancy");
  out << "</svg>\n";
  if (!out) throw Error("io", "cannot write " + file, "FIGURE.svg");
}

void run(const std::string& figure) {
  Renderer renderer({"", false});
  std::printf("half-plane, %ux%u, %d seeds, %s\n\n", size, size, static_cast<int>(seeds),
              renderer.device().name.c_str());
  std::printf("| light samples | low-discrepancy | random | 1 / (2 sqrt N) |\n|---|---|---|---|\n");
  std::vector<Row> rows;
  for (std::uint32_t samples = 16; samples <= 4096; samples *= 2) {
    rows.push_back({samples, error_of(renderer, "low-discrepancy", samples),
                    error_of(renderer, "random", samples)});
    std::printf("| %u | %.5f | %.5f | %.5f |\n", samples, rows.back().even, rows.back().random,
                0.5 / std::sqrt(samples));
  }
  const auto slope = [&](double Row::*column) {
    const Row& first = rows[4];
    return std::log(rows.back().*column / (first.*column)) /
           std::log(static_cast<double>(rows.back().samples) / first.samples);
  };
  std::printf("\nerror falls as N^%.2f (low-discrepancy), N^%.2f (random) from %u samples on\n",
              slope(&Row::even), slope(&Row::random), rows[4].samples);
  if (!figure.empty()) draw(figure, rows);
}

}  // namespace
}  // namespace penumbra

int main(int count, char** values) {
  std::string figure;
  return penumbra::bench::run_program(
      count, values, "Error of the reference against the number of light samples",
      [&](CLI::App& app) { app.add_option("FIGURE", figure, "A plot of it, .svg"); },
      [&] { penumbra::run(figure); });
}
