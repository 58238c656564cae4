#include "analysis/inspect/inspection.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/units.h"
#include "core/io/recording/range_step.h"
#include "core/io/recording/scan_table.h"
#include "core/points/point_alignment.h"

namespace railcast {
namespace {

constexpr double kFewest_m = 3.0;  // Nearer points tell little of their beam's elevation.
constexpr std::size_t kMostMotions = 10;

std::size_t SectorOf(double azimuth_rad) {
  const double share = azimuth_rad / (2.0 * std::numbers::pi) + 0.5;
  const auto sector = static_cast<std::size_t>(share * RecordingLook::kNumSectors);
  return std::min(sector, RecordingLook::kNumSectors - 1);
}

void AddPoint(const RecordedFrame& recorded,
              std::size_t slot,
              RecordingLook& inspection,
              std::vector<InspectedRing>& rings) {
  const Frame& frame = recorded.frame;
  const auto x_m = static_cast<double>(frame.x[slot]);
  const auto y_m = static_cast<double>(frame.y[slot]);
  const double range_m = static_cast<double>(frame.range_m[slot]);
  ++inspection.num_points;
  inspection.range_m.Add(range_m);
  if (range_m < RecordingLook::kNear_m) ++inspection.num_near;
  ++inspection.sectors[SectorOf(std::atan2(y_m, x_m))];
  if (recorded.Has("intensity"))
    inspection.intensity.Add(static_cast<double>(frame.intensity[slot]));
  if (!recorded.Has("ring")) return;
  const std::size_t ring = frame.ring[slot];
  if (ring >= rings.size()) rings.resize(ring + 1);
  InspectedRing& of = rings[ring];
  ++of.num_points;
  if (range_m < kFewest_m) return;
  const Vector3 spin_m = SpinPoint_m(frame, slot);
  of.elevation_deg.Add(DegFromRad(std::atan2(spin_m.z(), std::hypot(spin_m.x(), spin_m.y()))));
}

std::vector<Eigen::Vector3f> PointsToLay(const Frame& frame) {
  std::vector<Eigen::Vector3f> points_m;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (!std::isnan(frame.x[i])) points_m.emplace_back(frame.x[i], frame.y[i], frame.z[i]);
  }
  return points_m;
}

/// Compares the poses of frames that follow one another with their clouds.
class MotionCheck {
 public:
  void Add(const RecordedFrame& recorded, std::size_t frame, RecordingLook& inspection) {
    if (!recorded.has_pose || inspection.motions.size() == kMostMotions) {
      before_.reset();
      return;
    }
    Place now{ThinnedCloud(PointsToLay(recorded.frame)), recorded.frame.world_from_sensor};
    if (before_ && before_->cloud.size() >= kFewestLaid && now.cloud.size() >= kFewestLaid) {
      const Transform step = before_->world_from_sensor.inverse() * now.world_from_sensor;
      if (const auto laid = LayOn(before_->cloud, now.cloud, step)) {
        const Vector3 by_clouds_m = laid->onto_from_cloud.translation();
        inspection.motions.push_back({.frame = frame,
                                      .distance_m = step.translation().norm(),
                                      .off_m = (by_clouds_m - step.translation()).norm(),
                                      .registered_m = by_clouds_m.norm()});
      }
    }
    before_ = std::move(now);
  }

 private:
  struct Place {
    ThinnedCloud cloud;
    Transform world_from_sensor;
  };
  std::optional<Place> before_;
};

/// @returns What it has of rings.
std::vector<InspectedRing> LookAtFrame(const RecordedFrame& recorded, RecordingLook& inspection) {
  const Frame& frame = recorded.frame;
  ++inspection.num_frames;
  inspection.num_grids += recorded.is_grid ? 1 : 0;
  inspection.num_with_beams += recorded.beam_of ? 1 : 0;
  inspection.num_with_pose += recorded.has_pose ? 1 : 0;
  inspection.num_with_objects += recorded.objects.empty() ? 0 : 1;
  if (inspection.why_no_grid.empty()) inspection.why_no_grid = recorded.why_no_grid;
  if (inspection.why_no_ranges.empty()) inspection.why_no_ranges = recorded.why_no_ranges;
  for (const std::string& field : recorded.fields) ++inspection.fields[field];
  if (inspection.num_frames == 1) {
    inspection.origin_m = recorded.origin_m;
    for (const ForeignField& field : recorded.foreign) inspection.foreign.push_back(field.name);
  }
  inspection.stamps_ns.push_back(frame.stamp_ns);
  if (recorded.Has("time_ns")) {
    inspection.durations_s.push_back(SecondsFromNs(std::int64_t{frame.duration_ns}));
  }
  if (recorded.has_pose) {
    inspection.world_from_sensor.push_back(frame.world_from_sensor);
    inspection.pose_stamps_ns.push_back(frame.stamp_ns);
  }
  if (recorded.why_no_ranges.empty()) inspection.neighbours.Add(recorded);
  std::vector<InspectedRing> rings;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isnan(frame.x[slot])) AddPoint(recorded, slot, inspection, rings);
  }
  std::vector<std::uint64_t> ring_points;
  for (const InspectedRing& ring : rings) ring_points.push_back(ring.num_points);
  inspection.frames.push_back(InspectFrame(recorded, std::move(ring_points)));
  inspection.num_empty += inspection.frames.back().num_points == 0 ? 1 : 0;
  return rings;
}

/// Sums of rings by the number of the grids' rows.
class RingSums {
 public:
  void Add(std::uint32_t num_rows, const std::vector<InspectedRing>& rings) {
    auto& [num_frames, sums] = sums_[num_rows];
    ++num_frames;
    sums.resize(std::max(sums.size(), rings.size()));
    for (std::size_t i = 0; i < rings.size(); ++i) {
      sums[i].num_points += rings[i].num_points;
      sums[i].elevation_deg.Add(rings[i].elevation_deg);
    }
  }
  /// The rings of the most frames; if as many have others, those with the most rows.
  [[nodiscard]] std::vector<InspectedRing> Most() const {
    std::pair<std::size_t, std::vector<InspectedRing>> most;
    for (const auto& [num_rows, sums] : sums_) {
      if (sums.first >= most.first) most = sums;
    }
    return most.second;
  }

 private:
  std::map<std::uint32_t, std::pair<std::size_t, std::vector<InspectedRing>>> sums_;
};

/// Puts together what single frames show of the sensor, but for odd ones.
/// @param searches Of the first frames.
SensorSearch SensorWithoutOdd(const std::vector<InspectedFrame>& frames,
                              const std::vector<SensorSearch>& searches) {
  const bool are_all_odd = std::ranges::all_of(std::span(frames).first(searches.size()),
                                               &InspectedFrame::has_odd_points);
  SensorSearch sensor;
  for (std::size_t i = 0; i < searches.size(); ++i) {
    if (are_all_odd || !frames[i].has_odd_points) sensor.Add(searches[i]);
  }
  return sensor;
}

}  // namespace

void InspectedValues::Add(double value) {
  if (std::isnan(value)) {
    ++num_missing;
    return;
  }
  ++num;
  num_zero += value == 0.0 ? 1 : 0;
  least = std::min(least, value);
  if (value > highest) num_highest = 0;
  highest = std::max(highest, value);
  num_highest += value == highest ? 1 : 0;
  is_whole = is_whole && value == std::floor(value);
}

bool RecordingLook::HasStamps() const {
  return std::ranges::any_of(stamps_ns, [](std::int64_t stamp_ns) { return stamp_ns != 0; });
}

RecordingLook Inspect(Recording& recording, std::size_t most_frames) {
  RecordingLook inspection;
  MotionCheck motion;
  RingSums rings;
  std::vector<SensorSearch> searches;
  std::vector<double> steps_m;
  while (const auto read = recording.Next()) {
    if (inspection.num_frames == most_frames) {
      inspection.is_cut_short = true;
      // What is said of captures and bags as a whole is known at their end only.
      while (!recording.info().num_frames && recording.Next()) {
      }
      break;
    }
    const RecordedFrame recorded = (*read)();
    rings.Add(recorded.frame.rows, LookAtFrame(recorded, inspection));
    // Twice as many frames as a search takes, since half of them may be odd.
    if (searches.size() < 2 * SensorSearch::kMostFrames) searches.emplace_back().Add(recorded);
    steps_m.push_back(RangeStep_m(recorded));
    motion.Add(recorded, inspection.num_frames - 1, inspection);
  }
  inspection.rings = rings.Most();
  inspection.range_step_m = steps_m.empty() ? 0.0 : MedianOf(steps_m);
  JudgeFrames(inspection.HasStamps(), inspection.frames);
  inspection.sensor = SensorWithoutOdd(inspection.frames, searches);
  return inspection;
}

}  // namespace railcast
