#include "analysis/stats/statistics.h"

#include <algorithm>

#include "analysis/report/words.h"
#include "core/base/units.h"
#include "core/io/recording/firing_truth.h"

namespace railcast {
namespace {

constexpr double kSector_deg = 5.0;
constexpr std::size_t kNumSectors = 72;

// Number of squares of 1 m that hold a point.
std::uint64_t CountCells(const Frame& frame) {
  std::vector<std::uint64_t> cells;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    // Negated so that NaN is skipped, too.
    constexpr float kFarthest_m = 1e9F;
    if (!(frame.range_m[slot] < kFarthest_m)) continue;
    const auto x = static_cast<std::int32_t>(std::floor(frame.x[slot]));
    const auto y = static_cast<std::int32_t>(std::floor(frame.y[slot]));
    cells.push_back(std::uint64_t{static_cast<std::uint32_t>(x)} << 32U |
                    static_cast<std::uint32_t>(y));
  }
  std::sort(cells.begin(), cells.end());
  return static_cast<std::uint64_t>(std::unique(cells.begin(), cells.end()) - cells.begin());
}

}  // namespace

void Coverage::Add(const RecordedFrame& recorded, const ScanTable* scan) {
  const Frame& frame = recorded.frame;
  sectors_.resize(kNumSectors);
  std::uint64_t num_points = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isfinite(frame.range_m[slot])) continue;
    ++num_points;
    if (!recorded.why_no_ranges.empty()) continue;
    const double azimuth_deg = DegFromRad(
        std::atan2(static_cast<double>(frame.y[slot]), static_cast<double>(frame.x[slot])));
    const auto sector = static_cast<std::size_t>((azimuth_deg + 180.0) / kSector_deg);
    ++sectors_[std::min(sector, kNumSectors - 1)];
  }
  num_points_ += num_points;
  points_.Add(static_cast<double>(num_points));
  cells_.Add(static_cast<double>(CountCells(frame)));
  if (!recorded.is_grid || !recorded.why_no_ranges.empty()) return;
  if (rings_.size() < frame.rows) rings_.resize(frame.rows);
  for (std::size_t row = 0; row < frame.rows; ++row) {
    Ring& ring = rings_[row];
    if (scan != nullptr) ring.elevation_deg.Add(DegFromRad(scan->elevation_rad[row]));
    for (std::size_t column = 0; column < frame.columns; ++column) {
      const std::size_t slot = row * frame.width() + column * frame.returns;
      if (IsOnOwnVehicle(recorded, slot)) continue;
      ++ring.num_firings;
      ring.num_points += std::isfinite(frame.range_m[slot]) ? 1 : 0;
    }
  }
}

Section Coverage::MakeSection() const {
  Section section = SectionOf(kStatsWords, "coverage");
  Table frames = TableOf(kStatsWords, "frames");
  frames.rows = {{std::string("points"), PointsPerFrame()},
                 {std::string("squares of 1 m with a point"), OccupiedCells()}};
  section.tables.push_back(std::move(frames));

  Table rings = TableOf(kStatsWords, "rings");
  for (std::size_t i = 0; i < rings_.size(); ++i) {
    rings.rows.push_back({std::uint64_t{i}, rings_[i].elevation_deg.PlainMean(),
                          rings_[i].num_firings,
                          PercentProportion(rings_[i].num_points, rings_[i].num_firings)});
  }
  if (!rings_.empty()) {
    section.charts.push_back(ChartOfTable(kStatsWords, "rings", rings));
    section.tables.push_back(std::move(rings));
  }

  Table sectors = TableOf(kStatsWords, "azimuth");
  for (std::size_t i = 0; i < sectors_.size(); ++i) {
    const double middle_deg = -180.0 + (static_cast<double>(i) + 0.5) * kSector_deg;
    const Estimate rate = PoissonRate(sectors_[i], static_cast<double>(num_frames()));
    if (sectors_[i] > 0) sectors.rows.push_back({middle_deg, rate});
  }
  if (sectors.rows.empty()) return section;
  section.charts.push_back(ChartOfTable(kStatsWords, "azimuth", sectors));
  section.tables.push_back(std::move(sectors));
  return section;
}

}  // namespace railcast
