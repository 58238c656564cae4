#include "analysis/stats/statistics.h"

#include <algorithm>

#include "analysis/report/words.h"
#include "analysis/stats/bins.h"

namespace railcast {
namespace {

// Velocities beyond this, as a faulty foreign file may hold, share the last bin.
constexpr double kFastest_mps = 1000.0;

Table VelocityTable(const std::vector<Velocity::Sum>& sums, bool has_truth) {
  Table table = TableOf(kStatsWords, "velocity_by_range", {{"has_truth", has_truth}});
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Velocity::Sum& sum = sums[i];
    if (sum.num_points == 0) continue;
    std::vector<Cell> row = {RangeBins().span(i), sum.num_points,
                             PercentProportion(sum.measured_mps.num(), sum.num_points),
                             sum.measured_mps.Mean()};
    if (has_truth) {
      row.insert(row.end(), {sum.errors_mps.plain.Mean(), sum.errors_mps.plain.StandardDeviation(),
                             sum.errors_mps.robust.RobustScale()});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table DistributionTable(const std::map<std::int64_t, std::uint64_t>& distribution) {
  Table table = TableOf(kStatsWords, "velocities");
  std::uint64_t num_all = 0;
  for (const auto& [bin, num] : distribution) num_all += num;
  for (const auto& [bin, num] : distribution) {
    const double low_mps = kVelocityBin_mps * static_cast<double>(bin);
    table.rows.push_back(
        {Span{low_mps, low_mps + kVelocityBin_mps}, num, PercentProportion(num, num_all)});
  }
  return table;
}

}  // namespace

void Velocity::Add(const RecordedFrame& recorded) {
  if (!recorded.Has("radial_velocity_mps")) return;
  by_range_.resize(RangeBins().size());
  const bool has_truth = recorded.Has("true_radial_velocity_mps");
  has_truth_ = has_truth_ || has_truth;
  const Frame& frame = recorded.frame;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const auto bin = RangeBins().Find(static_cast<double>(frame.range_m[slot]));
    const auto measured_mps = static_cast<double>(frame.radial_velocity_mps[slot]);
    if (bin) ++by_range_[*bin].num_points;
    if (!std::isfinite(measured_mps)) continue;
    const double shown_mps = std::clamp(measured_mps, -kFastest_mps, kFastest_mps);
    ++distribution_[static_cast<std::int64_t>(std::floor(shown_mps / kVelocityBin_mps))];
    if (!bin) continue;
    Sum& sum = by_range_[*bin];
    sum.measured_mps.Add(measured_mps);
    if (!has_truth) continue;
    sum.errors_mps.Add(measured_mps - static_cast<double>(frame.true_radial_velocity_mps[slot]));
  }
}

Section Velocity::MakeSection() const {
  Section section = SectionOf(kStatsWords, "velocity", {{"has_truth", has_truth_}});
  section.tables = {VelocityTable(by_range_, has_truth_), DistributionTable(distribution_)};
  if (has_truth_) {
    section.charts.push_back(
        ChartOfTable(kStatsWords, "velocity_noise_by_range", section.tables.front()));
  }
  section.charts.push_back(ChartOfTable(kStatsWords, "velocities", section.tables.back()));
  return section;
}

}  // namespace railcast
