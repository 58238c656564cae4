#include "analysis/stats/difficulty.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "analysis/estimate/estimate.h"
#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "analysis/stats/sums.h"

namespace railcast {
namespace {

using DifficultyScale = Difficulty::Scale;

struct ScaleText {
  std::string_view key;
  std::string_view title;
  std::array<std::string_view, Difficulty::kMostGrades> grades;  // Empty ones do not exist.
};

constexpr std::array<ScaleText, Difficulty::kNumScales> kScales = {{
    {"kitti",
     "As KITTI grades",
     {"easy", "moderate", "hard", "harder than hard", "without points"}},
    {"occlusion",
     "Occlusion, classes of OSDaR23",
     {"0-25 %", "25-50 %", "50-75 %", "75-99 %", "100 %"}},
    {"truncation", "Truncation", {"none", "up to 15 %", "15-30 %", "30-50 %", "more than 50 %"}},
    {"points", "Points on the object", {"more than 100", "21 to 100", "6 to 20", "1 to 5", "none"}},
}};

constexpr double kKittiFocalLength_px = 721.5377;
// Hidden shares at which KITTI's levels of occlusion begin, as in scripts/export_kitti_objects.py.
constexpr double kPartlyHidden = 0.1, kLargelyHidden = 0.5;

struct KittiLimits {
  double min_height_px;
  double hidden_below;
  double max_truncation;
};
constexpr std::array<KittiLimits, 3> kKittiLimits = {
    {{40.0, kPartlyHidden, 0.15}, {25.0, kLargelyHidden, 0.30}, {25.0, 2.0, 0.50}}};
constexpr std::array<double, 3> kTruncationLimits = {0.15, 0.30, 0.50};
constexpr std::array<std::uint32_t, 4> kPointLimits = {100, 20, 5, 0};

struct AngleSpan {
  double low;
  double high;

  [[nodiscard]] bool Has(double value) const { return value >= low && value <= high; }
};

// From the least to the greatest of the values that are known, half a step farther on either side.
AngleSpan SpanOf(std::span<const double> values, double step) {
  AngleSpan span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double value : values) {
    if (std::isnan(value)) continue;
    span.low = std::min(span.low, value - 0.5 * step);
    span.high = std::max(span.high, value + 0.5 * step);
  }
  return span;
}

// Where the firings of a grid go.
struct FieldOfView {
  AngleSpan elevation_rad, azimuth_rad;
  bool is_full_turn;
  std::optional<Eigen::Matrix3d> sensor_from_spin;

  explicit FieldOfView(const ScanTable& scan)
      : elevation_rad(SpanOf(scan.elevation_rad, scan.row_step_rad)),
        azimuth_rad(SpanOf(scan.column_azimuth_rad, scan.column_step_rad)),
        is_full_turn(scan.is_full_turn),
        sensor_from_spin(scan.sensor_from_spin) {}

  [[nodiscard]] bool Has(Vector3 place_m) const {
    if (sensor_from_spin) place_m = sensor_from_spin->transpose() * place_m;
    const double elevation = std::atan2(place_m.z(), std::hypot(place_m.x(), place_m.y()));
    if (!elevation_rad.Has(elevation)) return false;
    // Columns are unwrapped: the direction is within half a turn of their middle.
    const double middle = 0.5 * (azimuth_rad.low + azimuth_rad.high);
    const double beside = WrappedAngle_rad(std::atan2(place_m.y(), place_m.x()) - middle);
    return is_full_turn || azimuth_rad.Has(middle + beside);
  }
};

std::size_t GradeOf(DifficultyScale scale, const RecordedObject& object, double truncation) {
  switch (scale) {
    case DifficultyScale::kKitti:
      return static_cast<std::size_t>(KittiGradeOf(object, truncation));
    case DifficultyScale::kOcclusion:
      return BinOf(kBinOcclusions, object.occlusion.value_or(0.0));
    case DifficultyScale::kTruncation:
      if (truncation <= 0.0) return 0;
      return 1 + static_cast<std::size_t>(std::ranges::lower_bound(kTruncationLimits, truncation) -
                                          kTruncationLimits.begin());
    case DifficultyScale::kPoints:
      break;
  }
  return static_cast<std::size_t>(std::ranges::count_if(
      kPointLimits, [&](std::uint32_t most) { return object.points <= most; }));
}

// The counts of all labels together.
Difficulty::Counts Total(const std::map<std::string, Difficulty::Counts>& by_label) {
  Difficulty::Counts total{};
  for (const auto& [label, counts] : by_label) AddTo(total, counts);
  return total;
}

// Calls visit(scale, grade, their names) for all grades of all scales.
template <typename Visitor>
void ForEachGrade(Visitor&& visit) {
  for (std::size_t scale = 0; scale < kScales.size(); ++scale) {
    for (std::size_t grade = 0; grade < Difficulty::kMostGrades; ++grade) {
      visit(scale, grade, std::string(kScales.at(scale).title),
            std::string(kScales.at(scale).grades.at(grade)));
    }
  }
}

Table GradesTable(const Difficulty::Counts& total) {
  Table table = TableOf(kStatsWords, "difficulty");
  Difficulty::Count all;  // The same in each scale.
  for (const Difficulty::Count& count : total.front()) AddTo(all, count);
  ForEachGrade([&](std::size_t scale, std::size_t grade, std::string title, std::string name) {
    const Difficulty::Count& count = total.at(scale).at(grade);
    table.rows.push_back({std::move(title), std::move(name), count.objects,
                          Percent(count.objects, all.objects), count.points,
                          Percent(count.points, all.points)});
  });
  return table;
}

Table LabelGradesTable(const std::map<std::string, Difficulty::Counts>& by_label) {
  Table table = TableOf(kStatsWords, "difficulty_by_label");
  for (const auto& [label, counts] : by_label) {
    ForEachGrade([&](std::size_t scale, std::size_t grade, std::string title, std::string name) {
      const Difficulty::Count& count = counts.at(scale).at(grade);
      table.rows.push_back({label, std::move(title), std::move(name), count.objects, count.points});
    });
  }
  return table;
}

Table DistanceGradesTable(const Difficulty::Counts& total) {
  Table table = TableOf(kStatsWords, "difficulty_by_distance");
  table.columns = DistanceColumns("scale: Scale; grade: Grade");
  ForEachGrade([&](std::size_t scale, std::size_t grade, std::string title, std::string name) {
    table.rows.push_back(
        RowOf({std::move(title), std::move(name)}, total.at(scale).at(grade).by_distance));
  });
  return table;
}

// Shares of the objects at each distance.
Chart GradesChart(const Difficulty::Counts& total, std::size_t scale) {
  const ScaleText& text = kScales.at(scale);
  Chart chart = ChartOf(kStatsWords, "difficulty_" + std::string(text.key));
  chart.x = DistanceAxis("Distance");
  for (std::size_t grade = 0; grade < Difficulty::kMostGrades; ++grade) {
    ChartSeries series{std::string(text.grades.at(grade)), SeriesStyle::kLinePoints};
    for (std::size_t bin = 0; bin < kNumDistanceBins; ++bin) {
      std::uint64_t all = 0;
      for (const Difficulty::Count& count : total.at(scale)) all += count.by_distance.at(bin);
      series.points.push_back(
          {static_cast<double>(bin), Percent(total.at(scale).at(grade).by_distance.at(bin), all)});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

double TruncationOf(const RecordedObject& object, const ScanTable& scan) {
  constexpr int kPlaces = 5;
  const FieldOfView view(scan);
  int num_outside = 0;
  for (int place = 0; place < kPlaces * kPlaces * kPlaces; ++place) {
    const int layer = place / (kPlaces * kPlaces);
    const Vector3 at(place % kPlaces, place / kPlaces % kPlaces, layer);
    const Vector3 in_box_m =
        ((at.array() + 0.5) / kPlaces - 0.5).matrix().cwiseProduct(object.size_m);
    num_outside += view.Has(object.sensor_from_box * in_box_m) ? 0 : 1;
  }
  return static_cast<double>(num_outside) / (kPlaces * kPlaces * kPlaces);
}

KittiGrade KittiGradeOf(const RecordedObject& object, double truncation) {
  if (object.points == 0) return KittiGrade::kNoPoints;
  const double height_px =
      kKittiFocalLength_px * object.size_m.z() / object.sensor_from_box.translation().norm();
  const double hidden = object.occlusion.value_or(0.0);
  const auto at = std::ranges::find_if(kKittiLimits, [&](const KittiLimits& limits) {
    return height_px >= limits.min_height_px && hidden < limits.hidden_below &&
           truncation <= limits.max_truncation;
  });
  return static_cast<KittiGrade>(at - kKittiLimits.begin());
}

void Difficulty::Add(const RecordedFrame& recorded, const ScanTable* scan) {
  for (const RecordedObject& object : recorded.objects) {
    // Out of the sensor's sight even alone, or seen by several sensors together.
    if (object.firings_alone == 0) continue;
    const double truncation = scan == nullptr ? 0.0 : TruncationOf(object, *scan);
    const std::size_t bin = BinOf(kBinDistances_m, object.sensor_from_box.translation().norm());
    Counts& counts = by_label_[object.label];
    for (std::size_t scale = 0; scale < kNumScales; ++scale) {
      Count& count = counts.at(scale).at(GradeOf(static_cast<Scale>(scale), object, truncation));
      ++count.objects;
      count.points += object.points;
      ++count.by_distance.at(bin);
    }
  }
}

Section Difficulty::MakeSection() const {
  const Counts total = Total(by_label_);
  Section section = SectionOf(kStatsWords, "difficulty");
  section.charts = {GradesChart(total, static_cast<std::size_t>(Scale::kKitti)),
                    GradesChart(total, static_cast<std::size_t>(Scale::kOcclusion))};
  section.tables = {GradesTable(total), LabelGradesTable(by_label_), DistanceGradesTable(total)};
  return section;
}

}  // namespace railcast
