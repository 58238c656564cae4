#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/report/chart_script.h"

namespace railcast {
namespace {

// As shares of the axes of a drawing on a sheet of four.
constexpr double kLetterWidth = 0.0135;
constexpr double kLineHeight = 0.055;
// From a point to its label, in letters and lines.
constexpr double kAside_letters = 0.8;
constexpr std::array<double, 6> kPlaces_lines = {0.7, -0.7, 1.7, -1.7, 2.7, -2.7};

double PlaceOn(double value, const AxisRange& range, bool is_log) {
  if (is_log) return std::log(value / range.low) / std::log(range.high / range.low);
  return (value - range.low) / (range.high - range.low);
}

/// A place on the drawing, as shares of its axes.
struct ChartPlace {
  double x{}, y{};
};

struct LabelBox {
  double left{}, right{}, low{}, high{};

  [[nodiscard]] bool Overlaps(const LabelBox& other) const {
    return left < other.right && other.left < right && low < other.high && other.low < high;
  }
  [[nodiscard]] bool Holds(const ChartPlace& place) const {
    return left < place.x && place.x < right && low < place.y && place.y < high;
  }
};

/// A way of placing a label beside its point.
struct LabelPlace {
  int side{};  ///< 1 = right of the point, -1 = left.
  double up_lines{};
};

LabelBox BoxOf(const ChartPlace& point, std::size_t num_letters, const LabelPlace& place) {
  const double near = point.x + place.side * kAside_letters * kLetterWidth;
  const double far = near + place.side * kLetterWidth * static_cast<double>(num_letters);
  const double middle = point.y + place.up_lines * kLineHeight;
  return {std::min(near, far), std::max(near, far), middle - 0.5 * kLineHeight,
          middle + 0.5 * kLineHeight};
}

/// Places the labels of a drawing one after another where they cost least.
class LabelPlacer {
 public:
  explicit LabelPlacer(const Drawing& drawing) : drawing_(drawing) {
    for (const ChartSeries& series : drawing.chart.series) AddLines(series);
  }

  [[nodiscard]] std::optional<ChartPlace> PlaceOf(const ChartPoint& point) const {
    const Chart& chart = drawing_.chart;
    if (!HasPlace(point.x, chart.x.is_log) || !HasPlace(point.y, chart.y.is_log)) return {};
    return ChartPlace{PlaceOn(point.x, drawing_.x, chart.x.is_log),
                      PlaceOn(point.y, drawing_.y, chart.y.is_log)};
  }

  [[nodiscard]] LabelPlace Put(const ChartPlace& point, std::size_t num_letters) {
    double least = std::numeric_limits<double>::infinity();
    LabelPlace best;
    for (const double up_lines : kPlaces_lines) {
      for (const int side : {1, -1}) {
        const LabelPlace place{side, up_lines};
        const double cost = CostOf(BoxOf(point, num_letters, place)) + std::abs(up_lines);
        if (cost >= least) continue;
        least = cost;
        best = place;
      }
    }
    placed_.push_back(BoxOf(point, num_letters, best));
    return best;
  }

 private:
  void AddLines(const ChartSeries& series) {
    constexpr int kParts = 40;
    const bool is_line = series.style == SeriesStyle::kLinePoints;
    std::optional<ChartPlace> last;
    for (const ChartPoint& point : series.points) {
      const auto place = PlaceOf(point);
      if (place && last && is_line) {
        for (int i = 1; i < kParts; ++i) {
          const double share = static_cast<double>(i) / kParts;
          drawn_.push_back(
              {last->x + share * (place->x - last->x), last->y + share * (place->y - last->y)});
        }
      }
      if (place) drawn_.push_back(*place);
      last = place;
    }
  }

  // Labels above each other cannot be read, and labels beyond the axes collide with the numbers
  // there; a line through a label is only untidy.
  [[nodiscard]] double CostOf(const LabelBox& box) const {
    double cost = 0.0;
    for (const LabelBox& other : placed_) cost += box.Overlaps(other) ? 100.0 : 0.0;
    if (box.low < 0.0 || box.left < 0.0 || box.right > 1.0) cost += 50.0;
    for (const ChartPlace& place : drawn_) cost += box.Holds(place) ? 0.5 : 0.0;
    return cost;
  }

  const Drawing& drawing_;
  std::vector<ChartPlace> drawn_;  ///< Points, and places along the lines between them.
  std::vector<LabelBox> placed_;
};

}  // namespace

std::string LabelsText(const Drawing& drawing) {
  LabelPlacer placer(drawing);
  std::string text;
  for (const ChartSeries& series : drawing.chart.series) {
    for (const ChartPoint& point : series.points) {
      const auto place = placer.PlaceOf(point);
      if (point.label.empty() || !place) continue;
      const auto [side, up_lines] = placer.Put(*place, point.label.size());
      text += "set label " + GnuplotQuoted(point.label) + " at " + GnuplotNumber(point.x) + "," +
              GnuplotNumber(point.y) + (side > 0 ? " left" : " right") + " offset " +
              GnuplotNumber(kAside_letters * side) + "," + GnuplotNumber(up_lines) + "\n";
    }
  }
  return text;
}

}  // namespace railcast
