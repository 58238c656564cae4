#pragma once

#include <array>
#include <string>
#include <vector>

#include "analysis/report/axis.h"
#include "analysis/report/report.h"

namespace railcast {

/// Of series one after another, then from the first again; colour-blind safe (Okabe and Ito, Color
/// Universal Design, 2008; without the yellow, which white hides).
inline constexpr std::array<const char*, 7> kSeriesColors = {
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f"};

/// How one chart is laid out.
struct Drawing {
  const Chart& chart;
  AxisRange x, y;
  /// Categories go down the left side and values to the right: long names need room.
  bool is_lying = false;
  std::vector<double> places;  ///< Of bars.
};

/// gnuplot's data blocks of all series, and the command that plots them.
struct PlotText {
  std::string data;
  std::string command;
};

[[nodiscard]] PlotText PlotOf(const Drawing& drawing);

}  // namespace railcast
