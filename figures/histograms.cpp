#include <algorithm>
#include <cmath>

#include "figures/charts.h"
#include "figures/panels.h"

namespace penumbra::figures {

std::string draw(const Histograms& chart) {
  Drawing drawing(chart.frame.width_mm);
  std::size_t bins = 0;
  double most = 0.0;
  std::vector<std::string> headings;
  for (const auto& panel : chart.panels) {
    headings.push_back(panel.label);
    bins = std::max(bins, panel.shares.size());
    for (const double share : panel.shares) most = std::max(most, share);
  }
  if (bins == 0 || !(most > 0.0)) {
    drawing.text({0.5 * drawing.width(), 24.0}, chart.frame.empty, {.anchor = Anchor::middle});
    return drawing.svg(40.0, chart.frame.title, chart.frame.description);
  }
  const double top = 104.0 * most;
  const auto ticks = ticks_between(0.0, top, 4);
  const PanelGrid grid = lay_out_panels(drawing, headings, chart.horizontal, chart.vertical,
                                        {.least_width = 92.0,
                                         .aspect = 0.5,
                                         .axis_width = width_of(ticks) + 6.0,
                                         .axis_height = line_height + 10.0});
  for (std::size_t i = 0; i < chart.panels.size(); ++i) {
    const Box& plot = grid.plots[i];
    const Scale vertical{0.0, top, plot.bottom, plot.top};
    const double first = chart.first;
    const Scale horizontal{first - 0.5, first + static_cast<double>(bins) - 0.5, plot.left,
                           plot.right};
    draw_vertical_axis(drawing, vertical, ticks, plot.left, plot.right);
    const auto& shares = chart.panels[i].shares;
    for (std::size_t bin = 0; bin < shares.size(); ++bin) {
      if (!(shares[bin] > 0.0)) continue;
      const double value = first + static_cast<double>(bin);
      drawing.rectangle({horizontal.at(value - 0.42), vertical.at(100.0 * shares[bin]),
                         horizontal.at(value + 0.42), plot.bottom},
                        "#5b8db8");
    }
    draw_horizontal_axis(
        drawing, horizontal,
        whole_ticks(chart.first, chart.first + static_cast<int>(bins) - 1, plot.width()),
        plot.bottom, std::nullopt);
    if (chart.panels[i].mark && horizontal.holds(*chart.panels[i].mark))
      drawing.mark({horizontal.at(*chart.panels[i].mark), plot.bottom + line_height + 6.0},
                   {Shape::triangle, ink}, 2.2);
  }
  return drawing.svg(grid.bottom, chart.frame.title, chart.frame.description);
}

}  // namespace penumbra::figures
