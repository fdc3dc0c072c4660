#pragma once

#include <string>
#include <vector>

#include "figures/axis.h"
#include "figures/drawing.h"

namespace penumbra::figures {

/// A grid of equal panels that share their axes' titles.
struct PanelGrid {
  std::size_t columns = 1;
  std::vector<Box> plots;  ///< the area inside the axes, one a panel
  std::vector<std::vector<std::string>> headings;
  double bottom = 0.0;  ///< below the horizontal axis' title
};

struct PanelNeeds {
  double least_width = 100.0;  ///< of a panel with its axis
  double aspect = 0.75;        ///< height of the plot to its width
  double axis_width = 20.0;    ///< of the vertical axis' labels
  double axis_height = 14.0;   ///< of the horizontal axis' labels
  double line_under_heading = 0.0;
};

/// Places the panels, draws their headings and the two titles.
PanelGrid lay_out_panels(Drawing& drawing, const std::vector<std::string>& headings,
                         const std::string& horizontal, const std::string& vertical,
                         const PanelNeeds& needs);

/// Marks with their names in columns below `top`; returns the bottom.
double draw_legend(Drawing& drawing, const std::vector<std::string>& series, double top);

}  // namespace penumbra::figures
