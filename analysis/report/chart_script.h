#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

/// Ends of an axis.
struct AxisRange {
  double low{};
  double high = 1.0;
};

struct AxisTick {
  double at{};
  std::string label;
};

/// Whether a value can be drawn on an axis.
[[nodiscard]] bool HasPlace(double value, bool is_log);

/// The range of y that shows all values of a chart and, unless they are far wider than the values
/// themselves, all intervals. Returns nothing if no point can be drawn.
[[nodiscard]] std::optional<AxisRange> RangeOfY(const Chart& chart);

/// The range of x.
[[nodiscard]] std::optional<AxisRange> RangeOfX(const Chart& chart);

/// Round numbers within a range, about `num_wanted` of them. gnuplot's own have no label on a
/// logarithmic axis but at powers of ten, none at all from 20 to 60, and say 2e+07 where these say
/// 2×10⁷, and 1400 for 1,400.
[[nodiscard]] std::vector<AxisTick> TicksIn(const AxisRange& range, bool is_log, int num_wanted);

/// Colours of the series, repeated after the last; colour-blind safe (Okabe and Ito, Color
/// Universal Design, 2008; without the yellow, which is too pale on white).
inline constexpr std::array<const char*, 7> kSeriesColors = {
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f"};

/// Colours that a style sheet may replace, beside those of the series.
inline constexpr const char* kGridColor = "#dddddd";
inline constexpr const char* kMutedColor = "#767676";

/// How the series of a report are painted, by their titles: the number stands for a colour, a type
/// of point and, from the eighth on, a dash.
using SeriesPaints = std::map<std::string, std::size_t>;

/// Paints every series of the charts, in all of which a title has one paint. Within a chart no two
/// titles have the same paint; titles that never meet may share one.
[[nodiscard]] SeriesPaints PaintsOf(const std::vector<Chart>& charts);

/// gnuplot commands that draw a chart as an SVG without title and background, and as a PNG with
/// both. A chart without any point says "not enough data".
/// @param paints Has the titles of the chart's series.
[[nodiscard]] std::string DrawingOf(const Chart& chart,
                                    const SeriesPaints& paints,
                                    const std::filesystem::path& svg,
                                    const std::filesystem::path& png);

/// gnuplot commands that draw several charts in two columns under one title, for any terminal, with
/// the paints of these charts.
[[nodiscard]] std::string SheetOf(const std::vector<Chart>& charts, const std::string& title);

/// Layout of one chart.
struct Drawing {
  const Chart& chart;
  const SeriesPaints& paints;
  AxisRange x, y;
  /// Categories run down the left side and values to the right, since long names need room.
  bool is_lying = false;

  [[nodiscard]] std::size_t PaintOf(const ChartSeries& series) const {
    return paints.at(series.title);
  }
};

/// The colour of a paint.
[[nodiscard]] inline const char* PaintColor(std::size_t paint) {
  return kSeriesColors[paint % kSeriesColors.size()];
}

/// gnuplot's data blocks of all series, and the command that plots them.
struct PlotText {
  std::string data;
  std::string command;
};

/// Defined in chart_series.cpp.
[[nodiscard]] PlotText PlotOf(const Drawing& drawing);

/// gnuplot commands for the labels of points, placed so that they do not meet (chart_labels.cpp).
[[nodiscard]] std::string LabelsText(const Drawing& drawing);

/// Quotes text for gnuplot; it must be drawn with `noenhanced` terminals. Uses single quotes, since
/// gnuplot executes text between backquotes inside double quotes.
[[nodiscard]] std::string GnuplotQuoted(const std::string& text);

/// A number to six digits, more than a chart can show; "NaN" if it is not finite.
[[nodiscard]] std::string GnuplotNumber(double value);

}  // namespace railcast
