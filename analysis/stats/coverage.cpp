#include "analysis/stats/coverage.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/stats/headings.h"
#include "core/io/recording/firing_truth.h"

namespace railcast {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kSector_deg = 5.0;
constexpr std::size_t kNumSectors = 72;

// How many squares of 1 m hold a point.
std::uint64_t CountCells(const Frame& frame) {
  std::vector<std::uint64_t> cells;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    // Also where the range is no number.
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
  std::map<std::uint32_t, std::uint64_t> points_per_label;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isfinite(frame.range_m[slot])) continue;
    ++num_points;
    const double azimuth_deg = kDegrees * std::atan2(static_cast<double>(frame.y[slot]),
                                                     static_cast<double>(frame.x[slot]));
    const auto sector = static_cast<std::size_t>((azimuth_deg + 180.0) / kSector_deg);
    ++sectors_[std::min(sector, kNumSectors - 1)];
    if (recorded.Has("label")) ++points_per_label[frame.label[slot]];
  }
  num_points_ += num_points;
  points_.Add(static_cast<double>(num_points));
  cells_.Add(static_cast<double>(CountCells(frame)));
  for (const auto& [label, num] : points_per_label) labels_[label].Add(static_cast<double>(num));
  if (!recorded.is_grid) return;
  if (rings_.size() < frame.rows) rings_.resize(frame.rows);
  for (std::size_t row = 0; row < frame.rows; ++row) {
    Ring& ring = rings_[row];
    if (scan != nullptr) ring.elevation_deg.Add(kDegrees * scan->elevation_rad[row]);
    for (std::size_t column = 0; column < frame.columns; ++column) {
      const std::size_t slot = row * frame.width() + column * frame.returns;
      if (IsOnOwnVehicle(recorded, slot)) continue;
      ++ring.num_firings;
      ring.num_points += std::isfinite(frame.range_m[slot]) ? 1 : 0;
    }
  }
}

void Coverage::Add(const Coverage& other) {
  num_points_ += other.num_points_;
  points_.Add(other.points_);
  cells_.Add(other.cells_);
  if (rings_.size() < other.rings_.size()) rings_.resize(other.rings_.size());
  for (std::size_t i = 0; i < other.rings_.size(); ++i) {
    rings_[i].elevation_deg.Add(other.rings_[i].elevation_deg);
    rings_[i].num_firings += other.rings_[i].num_firings;
    rings_[i].num_points += other.rings_[i].num_points;
  }
  if (sectors_.size() < other.sectors_.size()) sectors_.resize(other.sectors_.size());
  for (std::size_t i = 0; i < other.sectors_.size(); ++i) sectors_[i] += other.sectors_[i];
  for (const auto& [label, points] : other.labels_) labels_[label].Add(points);
}

Section Coverage::MakeSection(const Names& names) const {
  Section section;
  section.key = "coverage";
  section.title = "Coverage";
  section.paragraphs = {"Occupancy counts the squares of 1 m, seen from above, that hold a point."};
  Table frames;
  frames.key = "frames";
  frames.title = "A frame";
  frames.note =
      "Means over frames; consecutive frames resemble each other, so that the intervals "
      "are those of this stretch of line.";
  frames.columns = {{"figure", "Figure", ""}, {"mean", "Mean", ""}};
  frames.rows = {{std::string("points"), PointsPerFrame()},
                 {std::string("squares of 1 m with a point"), OccupiedCells()}};
  section.tables.push_back(std::move(frames));

  if (!labels_.empty()) {
    Table labels;
    labels.key = "points_by_label";
    labels.title = "Points by label";
    labels.note = "Per frame that has any.";
    labels.columns = {{"label", "Label", ""}, {"points", "Points", ""}};
    for (const auto& [label, points] : labels_) {
      labels.rows.push_back({names.OfLabel(label), points.Mean()});
    }
    section.tables.push_back(std::move(labels));
  }

  Table rings;
  rings.key = "rings";
  rings.title = "Rings";
  rings.note = "Firings known to have met the own vehicle do not count.";
  rings.columns = {{"ring", "Ring", ""},
                   {"elevation_deg", "Elevation", "deg"},
                   {"firings", "Firings", ""},
                   {"with_point", "With a point", ""}};
  Chart ring_chart;
  ring_chart.key = "rings";
  ring_chart.title = "Firings with a point by ring";
  ring_chart.x = {"Ring, 0 the lowest", ""};
  ring_chart.y = {"Share", ""};
  ChartSeries share{"share", SeriesStyle::kLinePoints, {}};
  for (std::size_t i = 0; i < rings_.size(); ++i) {
    const Estimate with_point = Proportion(rings_[i].num_points, rings_[i].num_firings);
    rings.rows.push_back(
        {std::uint64_t{i}, rings_[i].elevation_deg.PlainMean(), rings_[i].num_firings, with_point});
    share.points.push_back(PointAt(static_cast<double>(i), with_point));
  }
  ring_chart.series.push_back(std::move(share));
  if (!rings_.empty()) {
    section.tables.push_back(std::move(rings));
    section.charts.push_back(std::move(ring_chart));
  }

  Table sectors;
  sectors.key = "azimuth";
  sectors.title = "Azimuth";
  sectors.columns = {{"azimuth_deg", "Azimuth, left positive", "deg"},
                     {"points", "Points a frame", ""}};
  Chart sector_chart;
  sector_chart.key = "azimuth";
  sector_chart.title = "Points by azimuth";
  sector_chart.x = {"Azimuth, left positive", "deg"};
  sector_chart.y = {"Points per 5 deg and frame", ""};
  ChartSeries points{"points", SeriesStyle::kLinePoints, {}};
  for (std::size_t i = 0; i < sectors_.size(); ++i) {
    const double middle_deg = -180.0 + (static_cast<double>(i) + 0.5) * kSector_deg;
    const Estimate rate = PoissonRate(sectors_[i], static_cast<double>(num_frames()));
    if (sectors_[i] > 0) sectors.rows.push_back({middle_deg, rate});
    if (rate.is_enough()) points.points.push_back(PointAt(middle_deg, rate));
  }
  sector_chart.series.push_back(std::move(points));
  section.tables.push_back(std::move(sectors));
  section.charts.push_back(std::move(sector_chart));
  return section;
}

}  // namespace railcast
