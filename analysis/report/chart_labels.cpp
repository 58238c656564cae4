#include <algorithm>
#include <cmath>

#include "analysis/report/chart_script.h"

namespace railcast {
namespace {

// As shares of the axes of a small drawing.
constexpr double kLetterWidth = 0.012;
constexpr double kLetterHeight = 0.06;

double PlaceOn(double value, const AxisRange& range, bool is_log) {
  if (is_log) return std::log(value / range.low) / std::log(range.high / range.low);
  return (value - range.low) / (range.high - range.low);
}

// A label and its point; `right` and `up` are -1 or 1.
struct ChartLabel {
  const ChartPoint* point{};
  double x{}, y{};
  int right = 1, up = 1;
};

// Chooses the sides of labels. Of neighbours so close that their labels would meet, the left half
// has its labels on the left; in each half the higher points have theirs above. Isolated labels
// stand below the points of the first series and above those of the others, which keeps the series'
// labels apart.
void TakeSides(std::vector<ChartLabel>::iterator begin,
               std::vector<ChartLabel>::iterator end,
               bool is_first) {
  const auto middle = begin + (end - begin) / 2;
  for (auto label = begin; label != end; ++label) {
    const bool is_left = label < middle;
    const auto half_begin = is_left ? begin : middle, half_end = is_left ? middle : end;
    const auto num_higher = std::count_if(half_begin, half_end, [&](const ChartLabel& other) {
      return other.y > label->y || (other.y == label->y && &other < &*label);
    });
    label->right = is_left ? -1 : 1;
    label->up = 2 * num_higher < half_end - half_begin ? 1 : -1;
  }
  if (end - begin == 1 && is_first) begin->right = begin->up = -1;
  for (auto label = begin; label != end; ++label) {
    if (label->y < kLetterHeight) label->up = 1;
  }
}

}  // namespace

std::string LabelsText(const Drawing& drawing) {
  const Chart& chart = drawing.chart;
  std::string text;
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    std::vector<ChartLabel> labels;
    for (const ChartPoint& point : chart.series[i].points) {
      if (point.label.empty() || !HasPlace(point.x, chart.x.is_log)) continue;
      if (!HasPlace(point.y, chart.y.is_log)) continue;
      labels.push_back({&point, PlaceOn(point.x, drawing.x, chart.x.is_log),
                        PlaceOn(point.y, drawing.y, chart.y.is_log)});
    }
    for (auto begin = labels.begin(); begin != labels.end();) {
      auto end = begin + 1;
      const auto width = [](const ChartLabel& label) {
        return kLetterWidth * static_cast<double>(label.point->label.size());
      };
      while (end != labels.end() && std::abs(end->x - (end - 1)->x) < width(*(end - 1))) ++end;
      TakeSides(begin, end, i == 0);
      begin = end;
    }
    for (const ChartLabel& label : labels) {
      text += "set label " + GnuplotQuoted(label.point->label) + " at " +
              GnuplotNumber(label.point->x) + "," + GnuplotNumber(label.point->y) +
              (label.right > 0 ? " left" : " right") + " offset " +
              GnuplotNumber(0.8 * label.right) + "," + GnuplotNumber(0.7 * label.up) +
              " textcolor rgb '" + kSeriesColors[i % kSeriesColors.size()] + "'\n";
    }
  }
  return text;
}

}  // namespace railcast
