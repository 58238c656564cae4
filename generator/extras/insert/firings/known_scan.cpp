#include "generator/extras/insert/firings/known_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/median.h"
#include "core/io/cloud/scan_motion.h"
#include "core/io/recording/scan_table.h"
#include "core/scan/firing.h"

namespace railcast {
namespace {

/// How far beside its beam a point may lie: what float32 and the interpolation of poses take away.
constexpr double kBeside_m = 0.005;
constexpr double kBeside_rad = 1.7e-4;  // 0.01 deg.
/// Points with rows and columns may have noise across their beams, as those of rung `plausibility`.
constexpr double kNoise = 20.0;  ///< Times as much.
/// The share of points that must lie so near to the beams of their cells, ...
constexpr double kLeastOnBeams = 0.98;
/// ... and by how much their middle may be turned about the upright axis.
constexpr double kMostTurned_rad = 1.7e-4;
constexpr double kNotAhead = std::numeric_limits<double>::infinity();

Vector3 PointOfSlot(const Frame& frame, std::size_t slot) {
  return {static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
          static_cast<double>(frame.z[slot])};
}

/// How far a point lies beside the beam of a firing, as a multiple of what is permitted.
double Beside(const ScanPattern& pattern, std::size_t firing, Vector3 point_m) {
  point_m -= BeamOrigin_m(pattern, firing);
  const Vector3 direction = BeamDirection(pattern, firing);
  const double ahead_m = point_m.dot(direction);
  if (!(ahead_m > 0.0)) return kNotAhead;
  return (point_m - ahead_m * direction).norm() / (kBeside_m + kBeside_rad * ahead_m);
}

/// The azimuth of a point from the beam of its firing, counterclockwise. Where beams leave beside
/// the axis, these millimetres are left out.
double TurnedFromBeam(const ScanPattern& pattern,
                      std::size_t firing,
                      const Frame& frame,
                      std::size_t slot) {
  const double apart_rad =
      static_cast<double>(std::atan2(frame.y[slot], frame.x[slot]) -
                          std::atan2(pattern.direction_y[firing], pattern.direction_x[firing]));
  return WrappedAngle_rad(apart_rad);
}

std::uint32_t CellOfSlot(const Frame& frame, const ScanPattern& pattern, std::size_t slot) {
  const std::size_t cell = slot / frame.returns;
  return static_cast<std::uint32_t>(cell / frame.columns * pattern.columns + cell % frame.columns);
}

/// Whether the points lie on the beams of the cells that the frame states.
bool LieInCells(const ScanPattern& pattern,
                const std::vector<std::uint32_t>& firing_of_cell,
                const Frame& frame) {
  if (frame.rows > pattern.rows || frame.columns > pattern.columns) return false;
  std::size_t num = 0;
  std::size_t num_on_beams = 0;
  std::vector<double> turned_rad;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.x[slot])) continue;
    ++num;
    const std::uint32_t firing = firing_of_cell[CellOfSlot(frame, pattern, slot)];
    if (firing == kNoSlot) return false;
    num_on_beams += Beside(pattern, firing, PointOfSlot(frame, slot)) <= kNoise;
    turned_rad.push_back(TurnedFromBeam(pattern, firing, frame, slot));
  }
  if (num == 0) return frame.rows == pattern.rows && frame.columns == pattern.columns;
  return static_cast<double>(num_on_beams) >= kLeastOnBeams * static_cast<double>(num) &&
         std::abs(MedianOf(turned_rad)) <= kMostTurned_rad;
}

NewSlots ByCells(const ScanPattern& pattern, const Frame& frame) {
  NewSlots to{pattern.rows, pattern.columns, frame.returns, {}};
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    to.of_slot.push_back(CellOfSlot(frame, pattern, slot) * frame.returns +
                         static_cast<std::uint32_t>(slot % frame.returns));
  }
  return to;
}

/// Follows a scan, cell by cell.
class ScanFollower {
 public:
  ScanFollower(const ScanPattern& pattern,
               const std::vector<std::uint32_t>& firing_of_cell,
               const RecordedFrame& recorded)
      : pattern_(pattern),
        firing_of_cell_(firing_of_cell),
        motion_(recorded.frame),
        is_at_stamp_(recorded.axes == PointAxes::kSensorAtStamp) {}

  /// Returns the next cell, from the last one on, on whose beam the point lies; kNoSlot if none is.
  [[nodiscard]] std::uint32_t Follow(const Vector3& point_m) {
    for (std::size_t cell = cell_; cell < firing_of_cell_.size(); ++cell) {
      double beside = BesideCell(cell, point_m);
      if (beside > 1.0) continue;
      // A beam beside it may be nearer still.
      for (; cell + 1 < firing_of_cell_.size(); ++cell) {
        const double beside_next = BesideCell(cell + 1, point_m);
        if (beside_next >= beside) break;
        beside = beside_next;
      }
      cell_ = cell;
      return static_cast<std::uint32_t>(cell);
    }
    return kNoSlot;
  }

 private:
  [[nodiscard]] double BesideCell(std::size_t cell, const Vector3& point_m) const {
    const std::uint32_t firing = firing_of_cell_[cell];
    if (firing == kNoSlot) return kNotAhead;
    if (!is_at_stamp_) return Beside(pattern_, firing, point_m);
    return Beside(pattern_, firing, motion_.AtFiring(point_m, pattern_.time_ns[firing]));
  }

  const ScanPattern& pattern_;
  const std::vector<std::uint32_t>& firing_of_cell_;
  ScanMotion motion_;
  bool is_at_stamp_;
  std::size_t cell_ = 0;
};

std::optional<NewSlots> ByFollowing(const ScanPattern& pattern,
                                    const std::vector<std::uint32_t>& firing_of_cell,
                                    const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  ScanFollower follower(pattern, firing_of_cell, recorded);
  std::vector<std::uint32_t> cell_of_slot(frame.num_slots(), kNoSlot);
  std::vector<std::uint8_t> num_in_cell(firing_of_cell.size());
  std::vector<std::uint8_t> return_of_slot(frame.num_slots());
  std::uint32_t returns = 0;
  for (const std::uint32_t slot : recorded.slot_of_entry) {
    if (slot == kNoSlot || std::isnan(frame.x[slot])) continue;
    const std::uint32_t cell = follower.Follow(PointOfSlot(frame, slot));
    constexpr std::uint8_t kMostReturns = 3;
    if (cell == kNoSlot || num_in_cell[cell] == kMostReturns) return std::nullopt;
    cell_of_slot[slot] = cell;
    return_of_slot[slot] = num_in_cell[cell]++;
    returns = std::max<std::uint32_t>(returns, num_in_cell[cell]);
  }
  if (returns == 0) return std::nullopt;
  NewSlots to{pattern.rows, pattern.columns, returns, std::move(cell_of_slot)};
  for (std::size_t slot = 0; slot < to.of_slot.size(); ++slot) {
    std::uint32_t& moved = to.of_slot[slot];
    if (moved != kNoSlot) moved = moved * returns + return_of_slot[slot];
  }
  return to;
}

}  // namespace

std::vector<std::uint32_t> FiringsOfCells(const ScanPattern& pattern) {
  std::vector<std::uint32_t> firings(std::size_t{pattern.rows} * pattern.columns, kNoSlot);
  for (std::uint32_t i = 0; i < pattern.num_firings(); ++i) {
    firings[std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i]] = i;
  }
  return firings;
}

std::optional<NewSlots> FitToScan(const ScanPattern& pattern,
                                  const std::vector<std::uint32_t>& firing_of_cell,
                                  const RecordedFrame& recorded,
                                  bool is_own_scan) {
  const Frame& frame = recorded.frame;
  const bool is_at_firing = recorded.axes == PointAxes::kSensorAtFiring;
  const bool has_cells = recorded.is_grid && is_at_firing;
  const bool is_whole = frame.rows == pattern.rows && frame.columns == pattern.columns;
  if (has_cells && ((is_own_scan && is_whole) || LieInCells(pattern, firing_of_cell, frame))) {
    return ByCells(pattern, frame);
  }
  if (!is_at_firing && !recorded.has_pose) return std::nullopt;
  return ByFollowing(pattern, firing_of_cell, recorded);
}

}  // namespace railcast
