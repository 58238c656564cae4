#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/report/cell_text.h"
#include "analysis/report/chart_script.h"

namespace railcast {
namespace {

// Share of a category's width that its bars take together.
constexpr double kBarsShare = 0.8;
constexpr std::size_t kManyPoints = 60;
constexpr std::array<int, 7> kPointTypes = {7, 5, 9, 13, 11, 15, 7};

bool IsBars(const ChartSeries& series) {
  return series.style == SeriesStyle::kBars;
}

std::size_t CountBars(const Chart& chart) {
  return static_cast<std::size_t>(std::count_if(chart.series.begin(), chart.series.end(), IsBars));
}

// Numbers of one data line, in gnuplot's order of axes.
std::string Line(const std::vector<double>& numbers) {
  std::string line;
  for (const double number : numbers) line += GnuplotNumber(number) + " ";
  line.back() = '\n';
  return line;
}

// Clamps a number to the ends of the axis.
double Clamped(double y, const Drawing& drawing) {
  if (std::isnan(y)) return y;
  return std::clamp(y, drawing.y.low, drawing.y.high);
}

bool IsDrawn(const ChartPoint& point, const Chart& chart) {
  return HasPlace(point.x, chart.x.is_log) && HasPlace(point.y, chart.y.is_log);
}

bool HasInterval(const ChartPoint& point) {
  return std::isfinite(point.low) && std::isfinite(point.high);
}

// Interval in x of bar number `bar` at x.
AxisRange BarOf(double x, std::size_t bar, const Chart& chart) {
  const double width = kBarsShare / static_cast<double>(CountBars(chart));
  const double begin = x - kBarsShare / 2.0 + width * static_cast<double>(bar);
  return {begin, begin + width};
}

// The plot elements of one series and the data blocks that they use.
struct SeriesParts {
  std::string data;
  std::vector<std::string> back;   ///< Bands and bars: behind everything.
  std::vector<std::string> front;  ///< Lines, points, intervals.
};

std::string BlockName(std::size_t series) {
  std::string name = "s";
  return name += std::to_string(series);
}

std::string Block(const std::string& name, const std::string& lines) {
  return "$" + name + " << EOD\n" + lines + "EOD\n";
}

// gnuplot's selection of two columns, x and y, for a vertical or horizontal chart.
std::string Columns(const Drawing& drawing) {
  return drawing.is_lying ? " using 2:1" : " using 1:2";
}

std::string TitleOf(const ChartSeries& series) {
  return series.title.empty() ? " notitle" : " title " + GnuplotQuoted(series.title);
}

// An interval as a thin line at x, without caps.
std::string Whisker(double x, const ChartPoint& point, const Drawing& drawing) {
  const double low = Clamped(point.low, drawing);
  const double high = Clamped(point.high, drawing);
  return drawing.is_lying ? Line({low, x, high - low, 0.0}) : Line({x, low, 0.0, high - low});
}

SeriesParts BarParts(const ChartSeries& series,
                     std::size_t bar,
                     const std::string& name,
                     const Drawing& drawing) {
  SeriesParts parts;
  const std::string color = PaintColor(drawing.PaintOf(series));
  std::string bars, whiskers;
  const double base = drawing.chart.y.is_log ? drawing.y.low : Clamped(0.0, drawing);
  for (const ChartPoint& point : series.points) {
    if (!IsDrawn(point, drawing.chart)) continue;
    const AxisRange place = BarOf(point.x, bar, drawing.chart);
    const double low = std::min(base, point.y);
    const double high = std::max(base, point.y);
    bars += drawing.is_lying ? Line({high, point.x, low, high, place.low, place.high})
                             : Line({point.x, high, place.low, place.high, low, high});
    const double middle = (place.low + place.high) / 2.0;
    if (HasInterval(point)) whiskers += Whisker(middle, point, drawing);
  }
  if (!bars.empty()) {
    parts.data += Block(name + "b", bars);
    parts.back.push_back("$" + name + "b using 1:2:3:4:5:6 with boxxyerror fillstyle solid 0.85 " +
                         "noborder linecolor rgb '" + color + "'" + TitleOf(series));
  }
  if (!whiskers.empty()) {
    parts.data += Block(name + "w", whiskers);
    parts.front.push_back("$" + name + "w using 1:2:3:4 with vectors nohead linewidth 1.2 " +
                          "linecolor rgb '#000000' notitle");
  }
  return parts;
}

// The points between two gaps; for gnuplot an empty line ends a line or band.
struct CurveText {
  std::string points, band, whiskers;
};

CurveText CurveOf(const ChartSeries& series, const Drawing& drawing) {
  CurveText text;
  const bool has_line = series.style != SeriesStyle::kPoints;
  const auto is_band_point = [&](std::size_t i) {
    return i < series.points.size() && IsDrawn(series.points[i], drawing.chart) &&
           HasInterval(series.points[i]);
  };
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    const ChartPoint& point = series.points[i];
    if (!IsDrawn(point, drawing.chart)) {
      text.points += "\n";
      text.band += "\n";
      continue;
    }
    text.points += Line({point.x, point.y});
    if (!is_band_point(i)) {
      text.band += "\n";
      continue;
    }
    // A band needs two consecutive points and vertical charts.
    const bool has_neighbour = (i > 0 && is_band_point(i - 1)) || is_band_point(i + 1);
    if (has_line && has_neighbour && !drawing.is_lying) {
      text.band += Line({point.x, Clamped(point.low, drawing), Clamped(point.high, drawing)});
    } else {
      text.whiskers += Whisker(point.x, point, drawing);
      text.band += "\n";
    }
  }
  return text;
}

SeriesParts CurveParts(const ChartSeries& series, std::size_t index, const Drawing& drawing) {
  SeriesParts parts;
  const std::string name = BlockName(index);
  const CurveText curve = CurveOf(series, drawing);
  const std::size_t paint_number = drawing.PaintOf(series);
  const std::string paint = Joined({" linecolor rgb '", PaintColor(paint_number), "'"});
  if (curve.band.find_first_not_of('\n') != std::string::npos) {
    parts.data += Block(name + "i", curve.band);
    parts.back.push_back("$" + name +
                         "i using 1:2:3 with filledcurves fillstyle solid 0.2 noborder" + paint +
                         " notitle");
  }
  if (!curve.whiskers.empty()) {
    parts.data += Block(name + "w", curve.whiskers);
    parts.front.push_back("$" + name + "w using 1:2:3:4 with vectors nohead linewidth 1.2" + paint +
                          " notitle");
  }
  if (curve.points.find_first_not_of('\n') == std::string::npos) return parts;
  parts.data += Block(name + "p", curve.points);
  // An isolated point is drawn larger so that it can be found.
  const std::string size = series.points.size() > kManyPoints ? "0.35"
                           : series.points.size() == 1        ? "1"
                                                              : "0.6";
  const std::string dots = " pointtype " +
                           std::to_string(kPointTypes[paint_number % kPointTypes.size()]) +
                           " pointsize " + size;
  // Repeated colours get another dash type.
  // The first line is wider, so that its edges show where the next one covers it.
  const std::string line = std::string(index == 0 ? " linewidth 2.8" : " linewidth 1.8") +
                           " dashtype " + std::to_string(paint_number / kSeriesColors.size() + 1);
  std::string how = " with linespoints" + line + dots;
  if (series.style == SeriesStyle::kLine) how = " with lines" + line;
  if (series.style == SeriesStyle::kPoints) how = " with points" + dots;
  parts.front.push_back("$" + name + "p" + Columns(drawing) + how + paint + TitleOf(series));
  return parts;
}

// Whether a curve has a figure at x or goes on from one to the next across it.
bool PassesOver(const ChartSeries& curve, double x) {
  const ChartPoint* last = nullptr;
  for (const ChartPoint& point : curve.points) {
    if (std::isnan(point.y)) {
      last = nullptr;
      continue;
    }
    const double from = last == nullptr ? point.x : last->x;
    if (std::min(from, point.x) <= x && x <= std::max(from, point.x)) return true;
    last = &point;
  }
  return false;
}

// Where a chart has no figure: in the place of a bar, and where no curve of the same style passes.
// (Of other styles are limits and fits.)
std::set<double> MissingPlaces(const Chart& chart) {
  std::set<double> places;
  std::size_t bar = 0;
  for (const ChartSeries& series : chart.series) {
    for (const ChartPoint& point : series.points) {
      if (!std::isnan(point.y) || !HasPlace(point.x, chart.x.is_log)) continue;
      const bool is_passed =
          !IsBars(series) && std::ranges::any_of(chart.series, [&](const ChartSeries& other) {
            return other.style == series.style && PassesOver(other, point.x);
          });
      if (is_passed) continue;
      const AxisRange place =
          IsBars(series) ? BarOf(point.x, bar, chart) : AxisRange{point.x, point.x};
      places.insert(0.5 * (place.low + place.high));
    }
    bar += IsBars(series) ? 1 : 0;
  }
  return places;
}

// Crosses on the axis in the places without a figure.
SeriesParts MissingParts(const Drawing& drawing) {
  std::string crosses;
  for (const double x : MissingPlaces(drawing.chart)) {
    if (x < drawing.x.low || x > drawing.x.high) continue;
    crosses += Line({x, drawing.y.low});
  }
  if (crosses.empty()) return {};
  return {Block("missing", crosses),
          {},
          {Joined({"$missing", Columns(drawing),
                   " with points pointtype 2 pointsize 0.7 linewidth 1.5 linecolor rgb '",
                   kMutedColor, "' title 'no figure'"})}};
}

}  // namespace

PlotText PlotOf(const Drawing& drawing) {
  std::string data;
  std::vector<std::string> back, front;
  std::size_t bar = 0;
  for (std::size_t i = 0; i < drawing.chart.series.size(); ++i) {
    const ChartSeries& series = drawing.chart.series[i];
    SeriesParts parts = IsBars(series) ? BarParts(series, bar++, BlockName(i), drawing)
                                       : CurveParts(series, i, drawing);
    data += parts.data;
    back.insert(back.end(), parts.back.begin(), parts.back.end());
    front.insert(front.end(), parts.front.begin(), parts.front.end());
  }
  const SeriesParts missing = MissingParts(drawing);
  data += missing.data;
  front.insert(front.end(), missing.front.begin(), missing.front.end());
  back.insert(back.end(), front.begin(), front.end());
  std::string plot = "plot NaN notitle";
  for (const std::string& part : back) plot += ", \\\n  " + part;
  return {data + LabelsText(drawing), plot + "\n"};
}

}  // namespace railcast
