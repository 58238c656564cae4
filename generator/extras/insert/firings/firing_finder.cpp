#include "generator/extras/insert/firing_finder.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/cloud/scan_motion.h"
#include "core/io/recording/plausibility.h"
#include "core/io/recording/recording_kinds.h"
#include "core/scan/firing.h"
#include "core/scan/spinning_pattern.h"
#include "generator/extras/insert/firings/frame_slots.h"
#include "generator/extras/insert/firings/given_firings.h"
#include "generator/extras/insert/firings/known_scan.h"
#include "generator/extras/insert/firings/ring_firings.h"

namespace railcast {
namespace {

static_assert(kNoSlot == kNoEntry && kNoSlot == kNoFiring);

bool HasPoint(const Frame& frame, std::size_t slot) {
  return !std::isnan(frame.x[slot]);
}

GivenFiring FiringAt(const RecordedBeam& beam, const Frame& frame, std::size_t cell) {
  const Eigen::Vector3f direction = beam.direction.cast<float>();
  const Eigen::Vector3f origin_m = beam.origin_m.cast<float>();
  return {.direction = {direction.x(), direction.y(), direction.z()},
          .origin_m = {origin_m.x(), origin_m.y(), origin_m.z()},
          .time_ns = frame.time_ns[cell * frame.returns],
          .row = static_cast<std::uint16_t>(cell / frame.columns),
          .column = static_cast<std::uint32_t>(cell % frame.columns)};
}

/// Slots without a point get the times of their firings, if those of the others are known.
void FillTimes(RecordedFirings& firings) {
  RecordedFrame& recorded = firings.recorded;
  if (!recorded.Has("time_ns")) return;
  for (std::size_t cell = 0; cell < firings.firing_of_cell.size(); ++cell) {
    if (firings.firing_of_cell[cell] == kNoFiring) continue;
    const std::size_t first = firings.SlotOfCell(cell);
    for (std::size_t slot = first; slot < first + recorded.frame.returns; ++slot) {
      if (HasPoint(recorded.frame, slot)) continue;
      recorded.frame.time_ns[slot] = firings.pattern.time_ns[firings.firing_of_cell[cell]];
    }
  }
}

RecordedFirings Finished(RecordedFrame recorded,
                         ScanPattern pattern,
                         std::vector<std::uint32_t> firing_of_cell) {
  RecordedFirings firings{.recorded = std::move(recorded),
                          .entry_of_slot = {},
                          .pattern = std::move(pattern),
                          .firing_of_cell = std::move(firing_of_cell)};
  firings.entry_of_slot = EntriesOfSlots(firings.recorded);
  FillTimes(firings);
  return firings;
}

RecordedFirings OfGiven(RecordedFrame recorded, double rate_hz, std::vector<GivenFiring> given) {
  ScanPattern shape;
  shape.rate_hz = rate_hz;
  shape.rows = recorded.frame.rows;
  shape.columns = recorded.frame.columns;
  ScanPattern pattern = PatternOfFirings(shape, std::move(given));
  std::vector<std::uint32_t> firing_of_cell = FiringsOfCells(pattern);
  return Finished(std::move(recorded), std::move(pattern), std::move(firing_of_cell));
}

/// Throws unless the rows of a capture are the channels of the sensor.
void CheckCapture(const ScanSpec& scan, const RecordedFrame& recorded) {
  const auto* const sensor = std::get_if<SpinningSpec>(&scan.pattern);
  if (sensor == nullptr) return;
  const std::size_t num_rows = recorded.frame.rows;
  if (sensor->channels.size() != num_rows) {
    throw InputError("the sensor has " + NumberText(sensor->channels.size()) +
                     " channels, the recording " + NumberText(num_rows) + " rings");
  }
  const std::vector<std::uint16_t> rows = RowsByElevation(sensor->channels);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    constexpr double kMostBeside_deg = 1.0;
    const double recorded_deg = DegFromRad(std::asin(recorded.beam_of(rows[i], 0).direction.z()));
    const double channel_deg = sensor->channels[i].elevation_deg;
    if (std::abs(recorded_deg - channel_deg) <= kMostBeside_deg) continue;
    throw InputError("ring " + NumberText(rows[i]) + " of " + NumberText(num_rows) + " lies at " +
                     NumberText(std::round(100.0 * recorded_deg) / 100.0) +
                     " deg, the sensor's channel at " + NumberText(channel_deg) + " deg");
  }
}

/// Lasers that do not work: they return nothing in a turn in which both beside them return
/// something more often than not. Such a laser would not see an object either.
std::vector<bool> DeadRows(const Frame& frame) {
  std::vector<std::size_t> num_points(frame.rows);
  for (std::size_t cell = 0; cell < std::size_t{frame.rows} * frame.columns; ++cell) {
    if (HasPoint(frame, cell * frame.returns)) ++num_points[cell / frame.columns];
  }
  std::vector<bool> is_dead(frame.rows);
  for (std::size_t row = 1; row + 1 < frame.rows; ++row) {
    is_dead[row] = num_points[row] == 0 && 2 * num_points[row - 1] > frame.columns &&
                   2 * num_points[row + 1] > frame.columns;
  }
  return is_dead;
}

/// All cycles of a capture are in its packets, and the beams of all of them are known.
RecordedFirings OfCapture(const ScanSpec& scan, RecordedFrame recorded) {
  Frame& frame = recorded.frame;
  const double column_ns = kNsPerS / scan.rate_hz / frame.columns;
  const std::vector<bool> is_dead = DeadRows(frame);
  std::vector<GivenFiring> given;
  for (std::size_t cell = 0; cell < std::size_t{frame.rows} * frame.columns; ++cell) {
    const auto row = static_cast<std::uint32_t>(cell / frame.columns);
    if (is_dead[row]) continue;
    const auto column = static_cast<std::uint32_t>(cell % frame.columns);
    given.push_back(FiringAt(recorded.beam_of(row, column), frame, cell));
    // The sensor's clock has jumped during the turn.
    if (!recorded.Has("time_ns")) {
      given.back().time_ns = static_cast<std::uint32_t>(column_ns * column);
    }
  }
  return OfGiven(std::move(recorded), scan.rate_hz, std::move(given));
}

/// Moves the beams of a scan to where the sensor's motion puts them at the stamp.
void MoveToStamp(const Frame& frame, ScanPattern& pattern) {
  const ScanMotion motion(frame);
  const std::size_t num = pattern.num_firings();
  for (auto* origins_m : {&pattern.origin_x_m, &pattern.origin_y_m, &pattern.origin_z_m}) {
    origins_m->resize(num);
  }
  for (std::size_t i = 0; i < num; ++i) {
    const Vector3 origin_m = BeamOrigin_m(pattern, i);
    const Vector3 ahead_m = origin_m + BeamDirection(pattern, i);
    const Vector3 moved_m = motion.AtStamp(origin_m, pattern.time_ns[i]);
    const Vector3 turned = motion.AtStamp(ahead_m, pattern.time_ns[i]) - moved_m;
    pattern.origin_x_m[i] = static_cast<float>(moved_m.x());
    pattern.origin_y_m[i] = static_cast<float>(moved_m.y());
    pattern.origin_z_m[i] = static_cast<float>(moved_m.z());
    pattern.direction_x[i] = static_cast<float>(turned.x());
    pattern.direction_y[i] = static_cast<float>(turned.y());
    pattern.direction_z[i] = static_cast<float>(turned.z());
  }
}

/// Each point counts as a firing from the sensor's origin.
RecordedFirings OfPoints(double rate_hz, RecordedFrame recorded) {
  const Frame& frame = recorded.frame;
  std::vector<GivenFiring> given;
  for (std::size_t cell = 0; cell < std::size_t{frame.rows} * frame.columns; ++cell) {
    const std::size_t first = cell * frame.returns;
    for (std::size_t slot = first; slot < first + frame.returns; ++slot) {
      if (!HasPoint(frame, slot)) continue;
      const Vector3 point_m(static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
                            static_cast<double>(frame.z[slot]));
      given.push_back(FiringAt({.direction = point_m.normalized()}, frame, cell));
      given.back().time_ns = frame.time_ns[slot];
      break;
    }
  }
  RecordedFirings firings = OfGiven(std::move(recorded), rate_hz, std::move(given));
  firings.are_points_alone = true;
  return firings;
}

}  // namespace

struct FiringFinder::Parts {
  ScanSpec scan;
  ScanPattern pattern;                        ///< The pattern of frame 0.
  std::vector<std::uint32_t> firing_of_cell;  ///< Firings of `pattern`.
  bool may_use_points_alone{};
  bool is_followed{};  ///< Whether railcast wrote clouds that do not state their beams.
  bool is_own_scan{};  ///< Whether the recording itself says that this is its scan.

  [[nodiscard]] RecordedFirings Find(RecordedFrame& recorded) const {
    if (recorded.beam_of) {
      CheckCapture(scan, recorded);
      return OfCapture(scan, std::move(recorded));
    }
    if (auto firings = FindInScan(recorded)) return std::move(*firings);
    const auto* const sensor = std::get_if<SpinningSpec>(&scan.pattern);
    if (is_followed && !recorded.is_grid) {
      throw InputError(
          "its points do not lie on the beams of the sensor; which beam a point is of is lost "
          "where its noise is across the beam, as that of fidelity plausibility is without "
          "lidar.plausibility.noise_shape beam");
    }
    if (sensor == nullptr) throw InputError("its points do not lie on the beams of the sensor");
    if (!recorded.is_grid) throw InputError(recorded.why_no_grid);
    if (recorded.axes != PointAxes::kSensorAtFiring) {
      throw InputError(
          "its points are in the axes of the stamp, and do not lie on the beams of the sensor");
    }
    std::vector<GivenFiring> given = FindRingFirings(*sensor, scan.rate_hz, recorded);
    return OfGiven(std::move(recorded), scan.rate_hz, std::move(given));
  }

  [[nodiscard]] std::optional<RecordedFirings> FindInScan(RecordedFrame& recorded) const {
    ScanPattern of_frame =
        PatternOfFrame(pattern, std::min(recorded.frame.index, pattern.LastFrame()));
    const auto slots = FitToScan(of_frame, firing_of_cell, recorded, is_own_scan);
    if (!slots) return std::nullopt;
    const Frame& frame = recorded.frame;
    const bool is_same = recorded.is_grid && slots->rows == frame.rows &&
                         slots->columns == frame.columns && slots->returns == frame.returns &&
                         recorded.axes == PointAxes::kSensorAtFiring;
    if (!is_same) MoveSlots(*slots, recorded);
    if (recorded.axes == PointAxes::kSensorAtStamp) MoveToStamp(recorded.frame, of_frame);
    return Finished(std::move(recorded), std::move(of_frame), firing_of_cell);
  }
};

FiringFinder::FiringFinder(const RecordingInfo& info,
                           const ScanSpec& scan,
                           bool may_use_points_alone) {
  Parts parts{.scan = scan,
              .pattern = BuildScanPattern(scan),
              .firing_of_cell = {},
              .may_use_points_alone = may_use_points_alone,
              .is_followed = info.origin.has_value() && info.has_kitti_labels,
              .is_own_scan = IsSimulated(info) && info.scenario->lidar.scan == scan};
  parts.firing_of_cell = FiringsOfCells(parts.pattern);
  parts_ = std::make_unique<const Parts>(std::move(parts));
}

FiringFinder::~FiringFinder() = default;

RecordedFirings FiringFinder::Find(RecordedFrame recorded) const {
  NeedRanges(recorded);
  const std::string place = recorded.name + ": its firings cannot be found: ";
  if (!parts_->may_use_points_alone) {
    return AtPlace(place, [&] { return parts_->Find(recorded); });
  }
  try {
    return parts_->Find(recorded);
  } catch (const InputError&) {
    return OfPoints(parts_->scan.rate_hz, std::move(recorded));
  }
}

}  // namespace railcast
