#include "analysis/stats/range_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/base/rounded_scale.h"
#include "core/base/text.h"
#include "core/io/recording/column_finder.h"
#include "core/io/recording/range_step.h"

namespace railcast {
namespace {

constexpr double kMostBend_m = 0.3;
constexpr double kMostSlope_m = 0.3;  // Per column.

// NaN where no surface returned.
double RangeAt_m(const RecordedFrame& recorded, std::size_t row, std::size_t column) {
  const Frame& frame = recorded.frame;
  const std::size_t slot = row * frame.width() + column * frame.returns;
  if (!HasSurfacePoint(recorded, slot)) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(frame.range_m[slot]);
}

/// Change of range from one column to the next; nothing where the surface bends or points are
/// missing.
std::optional<double> Slope_m(const RecordedFrame& recorded, std::size_t row, std::size_t column) {
  if (column == 0 || column + 1 >= recorded.frame.columns) return std::nullopt;
  const double left_m = RangeAt_m(recorded, row, column - 1);
  const double right_m = RangeAt_m(recorded, row, column + 1);
  const double bend_m = RangeAt_m(recorded, row, column) - 0.5 * (left_m + right_m);
  const double slope_m = 0.5 * (right_m - left_m);
  // Negated so that NaN fails, too.
  if (!(std::abs(bend_m) < kMostBend_m && std::abs(slope_m) < kMostSlope_m)) return std::nullopt;
  return slope_m;
}

/// The step of ranges by their changes from turn to turn, which show finer ones than differences of
/// neighbours do, since surfaces' slopes are not in them. 0 where none shows, as where none
/// changes.
double StepOfChanges(std::vector<double> changes) {
  if (changes.empty()) return 0.0;
  std::vector<double> sorted = changes;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  // It is one of the changes, so that the others differ from it by whole steps.
  for (double& change : changes) change -= *middle;
  return FindStep(changes);
}

}  // namespace

WordValue StepValue(const Moments& step_m) {
  return {"step_mm", step_m.num() == 0 ? "" : ShortText(1e3 * step_m.PlainMean())};
}

bool HasMoved(const RecordedFrame& earlier, const RecordedFrame& later) {
  const Transform motion =
      earlier.frame.world_from_sensor.inverse() * later.frame.world_from_sensor;
  constexpr double kStill_m = 1e-4;
  constexpr double kStill_rad = 1e-6;
  return motion.translation().norm() > kStill_m ||
         Eigen::AngleAxisd(motion.linear()).angle() > kStill_rad;
}

Estimate TemporalNoise::Bin::Sigma_m() const {
  return Scaled(differences_m.plain.StandardDeviation(), 1.0 / std::numbers::sqrt2);
}

Estimate TemporalNoise::Bin::RobustSigma_m() const {
  return Scaled(differences_m.robust.RobustScale(step_m.PlainMean(), RoundedValues::kBoth),
                1.0 / std::numbers::sqrt2);
}

void TemporalNoise::Add(const RecordedFrame& earlier,
                        const RecordedFrame& later,
                        const ScanTable* earlier_scan,
                        const ScanTable* later_scan) {
  if (earlier_scan == nullptr || later_scan == nullptr) return;
  const Frame& a = earlier.frame;
  const Frame& b = later.frame;
  if (a.rows != b.rows) return;
  if (earlier.has_pose && later.has_pose) {
    if (HasMoved(earlier, later)) {
      ++num_moved_;
      return;
    }
  } else {
    ++num_without_pose_;
  }
  ++num_pairs_;
  bins_.resize(RangeBins().size());
  std::vector<double> changes_m;
  const ColumnFinder finder(*earlier_scan);
  // Azimuth step per column, signed by the rotor's direction.
  const auto& azimuths_rad = earlier_scan->column_azimuth_rad;
  const double step_rad =
      earlier_scan->column_step_rad *
      (azimuths_rad.size() > 1 && azimuths_rad.back() < azimuths_rad.front() ? -1.0 : 1.0);
  for (std::size_t column = 0; column < b.columns; ++column) {
    const double azimuth_rad = later_scan->column_azimuth_rad[column];
    if (std::isnan(azimuth_rad)) continue;
    const auto found = finder.Nearest(azimuth_rad);
    if (!found || std::abs(found->offset_rad) > 0.5 * earlier_scan->column_step_rad) continue;
    const double offset = found->offset_rad / step_rad;  // In columns.
    for (std::size_t row = 0; row < b.rows; ++row) {
      const auto slope_m = Slope_m(earlier, row, found->column);
      const auto later_slope_m = Slope_m(later, row, column);
      if (!slope_m || !later_slope_m) continue;
      const double range_m = RangeAt_m(earlier, row, found->column);
      const double change_m = RangeAt_m(later, row, column) - range_m;
      const double difference_m = change_m - offset * 0.5 * (*slope_m + *later_slope_m);
      changes_m.push_back(change_m);
      const auto bin = RangeBins().Find(range_m);
      if (bin) bins_[*bin].differences_m.Add(difference_m);
    }
  }
  double step_m = StepOfChanges(std::move(changes_m));
  if (step_m == 0.0) step_m = RangeStep_m(later);
  if (step_m == 0.0) return;
  for (Bin& bin : bins_) bin.step_m.Add(step_m);
}

Section TemporalNoise::MakeSection() const {
  constexpr double kMm = 1e3;
  const bool is_any = num_pairs_ > 0;
  Section section = SectionOf(kStatsWords, "temporal_noise",
                              {{"num_pairs", std::to_string(num_pairs_)},
                               {"num_moved", num_moved_ > 0 ? std::to_string(num_moved_) : ""},
                               {"without_pose", num_without_pose_ > 0},
                               {"none", !is_any},
                               {"few", is_any && num_pairs_ < kMinSamples}});
  if (!is_any) return section;
  Moments step_m;
  for (const Bin& bin : bins_) step_m.Add(bin.step_m);
  Table table = TableOf(kStatsWords, "temporal_noise", {StepValue(step_m)});
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    if (bins_[i].differences_m.num() == 0) continue;
    table.rows.push_back({RangeBins().span(i), Scaled(bins_[i].Sigma_m(), kMm),
                          Scaled(bins_[i].RobustSigma_m(), kMm)});
  }
  section.charts.push_back(ChartOfTable(kStatsWords, "temporal_noise_by_range", table));
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace railcast
