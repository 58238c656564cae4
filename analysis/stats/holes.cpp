#include "analysis/stats/holes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "core/io/recording/firing_truth.h"

namespace railcast {
namespace {

constexpr std::size_t kReach = 4;  // Neighbours on either side.
constexpr std::size_t kNumNeighbours = 2 * kReach;
constexpr double kSmooth_m = 0.03;
constexpr double kEqualFactor = 1.5;
constexpr double kIntensityStep = 0.01;

using Neighbours = Eigen::Array<double, static_cast<int>(kNumNeighbours), 1>;

// The places of the neighbours in columns from the firing.
const Neighbours& Places() {
  static const Neighbours places{{-4.0, -3.0, -2.0, -1.0, 1.0, 2.0, 3.0, 4.0}};
  return places;
}

// Standard deviation of the ranges about their line, which has two parameters.
double DeviationFromLine_m(const Neighbours& ranges_m) {
  const Neighbours& places = Places();
  const double slope_m = (places * ranges_m).sum() / places.square().sum();
  const Neighbours rest_m = ranges_m - ranges_m.mean() - slope_m * places;
  return std::sqrt(rest_m.square().sum() / static_cast<double>(kNumNeighbours - 2));
}

bool IsOneBrightness(const Neighbours& intensities) {
  return intensities.maxCoeff() <= 1.0 &&
         intensities.maxCoeff() <= kEqualFactor * intensities.minCoeff() + 1.01 * kIntensityStep;
}

constexpr float kRelativeTolerance = 0.05F;
constexpr float kTolerance_m = 0.1F;

float Range_m(const Frame& frame, std::size_t row, std::size_t column) {
  return frame.range_m[row * frame.width() + column * frame.returns];
}

bool HasPoints(const Frame& frame, std::size_t column) {
  for (std::size_t row = 0; row < frame.rows; ++row) {
    if (std::isfinite(Range_m(frame, row, column))) return true;
  }
  return false;
}

void AddRow(const Cell& name, const HoleCount& count, Table& table) {
  if (count.num_expected == 0) return;
  table.rows.push_back(
      {name, count.num_expected, PercentProportion(count.num_missing, count.num_expected)});
}

}  // namespace

const Bins& SmoothHoles::Intensities() {
  static const Bins bins({0.0, 0.005, 0.015, 0.025, 0.035, 0.045, 0.055, 0.075, 0.105, 0.155, 0.205,
                          0.305, 0.505, 1.005});
  return bins;
}

void SmoothHoles::AddFiring(const Frame& frame, std::size_t row, std::size_t column) {
  if (column < kReach || column + kReach >= frame.columns) return;
  const Neighbours& places = Places();
  const std::size_t firing = row * frame.width() + column * frame.returns;
  Neighbours ranges_m;
  Neighbours intensities;
  for (Eigen::Index i = 0; i < places.size(); ++i) {
    const auto away = static_cast<std::ptrdiff_t>(places[i]) * std::ptrdiff_t{frame.returns};
    const auto slot = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(firing) + away);
    ranges_m[i] = static_cast<double>(frame.range_m[slot]);
    intensities[i] = static_cast<double>(frame.intensity[slot]);
  }
  // Negated so that NaN counts as no surface.
  if (!(DeviationFromLine_m(ranges_m) <= kSmooth_m) || !IsOneBrightness(intensities)) return;
  const auto bin = Intensities().Find(intensities.mean());
  if (!bin) return;
  by_intensity_.resize(Intensities().size());
  by_intensity_[*bin].Add(
      {{1, std::isfinite(frame.range_m[firing]) ? 0U : 1U}, intensities.mean()});
}

std::optional<double> RangeBetweenNeighbours_m(const Frame& frame,
                                               std::size_t row,
                                               std::size_t column) {
  const float left_m = Range_m(frame, row, column - 1);
  const float right_m = Range_m(frame, row, column + 1);
  const float mean_m = 0.5F * (left_m + right_m);
  const float tolerance_m = std::max(kTolerance_m, kRelativeTolerance * mean_m);
  // Negated so that NaN counts as no surface.
  if (!(std::abs(left_m - right_m) < tolerance_m)) return std::nullopt;
  return static_cast<double>(mean_m);
}

void Holes::Add(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  if (!recorded.is_grid || frame.columns < 3) return;
  std::vector<bool> has_points(frame.columns);
  for (std::size_t column = 0; column < frame.columns; ++column) {
    has_points[column] = HasPoints(frame, column);
  }
  for (std::size_t row = 0; row < frame.rows; ++row) {
    for (std::size_t column = 0; column < frame.columns; ++column) {
      if (IsOnOwnVehicle(recorded, row * frame.width() + column * frame.returns)) continue;
      if (has_points[column]) {
        ++num_firings_;
        num_points_ += std::isfinite(Range_m(frame, row, column)) ? 1 : 0;
      }
      smooth_.AddFiring(frame, row, column);
      const bool is_inside = column > 0 && column + 1 < frame.columns;
      if (is_inside) AddFiring(frame, row, column);
    }
  }
}

void Holes::AddFiring(const Frame& frame, std::size_t row, std::size_t column) {
  const auto mean_m = RangeBetweenNeighbours_m(frame, row, column);
  if (!mean_m) return;
  const Count count{1, std::isfinite(Range_m(frame, row, column)) ? 0U : 1U};
  all_.Add(count);
  groups_.Add(GroupBy::kRing, row, count);
  groups_.Add(GroupBy::kRange, RangeBins().Find(*mean_m), count);
}

Section Holes::MakeSection() const {
  Section section = SectionOf(kStatsWords, "holes");

  Table fill = TableOf(kStatsWords, "grid");
  fill.rows = {{std::string("firings with a point (the rest: sky, too far, lost)"), num_firings_,
                Scaled(Filled(), 100.0)},
               {std::string("holes among firings between two points of one surface"),
                all_.num_expected, Scaled(Share(), 100.0)}};
  section.tables.push_back(std::move(fill));
  const auto table_of = [&](GroupBy by, Table table) {
    groups_.ForEach(by, Names(RecordingInfo{}),
                    [&](const Cell& name, const Count& count) { AddRow(name, count, table); });
    return table;
  };
  Table by_range = table_of(GroupBy::kRange, TableOf(kStatsWords, "holes_by_range"));
  section.charts.push_back(ChartOfTable(kStatsWords, "holes_by_range", by_range));
  section.tables.push_back(std::move(by_range));
  if (const auto& counts = smooth_.by_intensity(); !counts.empty()) {
    Table smooth = TableOf(kStatsWords, "smooth_holes_by_intensity");
    for (std::size_t i = 0; i < counts.size(); ++i) {
      AddRow(SmoothHoles::Intensities().span(i), counts[i].firings, smooth);
    }
    section.tables.push_back(std::move(smooth));
  }
  if (has_rings_) {
    section.tables.push_back(table_of(GroupBy::kRing, TableOf(kStatsWords, "holes_by_ring")));
  }
  return section;
}

}  // namespace railcast
