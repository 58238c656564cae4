#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/clearance/clear_space.h"
#include "core/rail/line/track_course.h"
#include "railcast/io/recording.h"
#include "railcast/rail_world.h"
#include "viewer/color/palette.h"
#include "viewer/overlays/overlays.h"

namespace railcast {
namespace {

/// A stretch of the vehicle's track, as the sensor of one frame sees it.
struct TrackStretch {
  Alignment alignment;
  TrackCourse track;
  double from_s_m{};  ///< Chainages between which the track exists: from_s_m < to_s_m.
  double to_s_m{};
  Transform sensor_from_world = Transform::Identity();  ///< At the stamp.

  /// Returns the track frame at a chainage: x along the track, y left, z up, leaning with the cant;
  /// its origin is on the track's axis at top of rail.
  [[nodiscard]] Transform SensorFromTrack(double s_m) const;
  /// Returns chainages to draw lines through: the ends and every whole metre between. Chords of 1 m
  /// are within 1^2 / (8 R) of a curve: 5 mm down to a radius of 25 m, 0.9 mm at the 140 m of
  /// sidings.
  [[nodiscard]] std::vector<double> LineChainages_m() const;
};

Transform TrackStretch::SensorFromTrack(double s_m) const {
  return sensor_from_world * track.WorldFromTrack(alignment, s_m);
}

std::vector<double> TrackStretch::LineChainages_m() const {
  std::vector<double> chainages_m = WholeChainages_m(from_s_m, to_s_m, 1.0);
  if (chainages_m.empty() || chainages_m.front() > from_s_m) {
    chainages_m.insert(chainages_m.begin(), from_s_m);
  }
  if (chainages_m.back() < to_s_m) chainages_m.push_back(to_s_m);
  return chainages_m;
}

/// Returns the stretch from `behind_m` behind the vehicle's origin to `ahead_m` ahead of it,
/// whichever way along the chainage the vehicle faces. Empty if the frame has no pose or the track
/// does not extend there.
std::optional<TrackStretch> StretchAbout(const RailWorld& world,
                                         const RecordedFrame& recorded,
                                         double behind_m,
                                         double ahead_m) {
  if (!recorded.has_pose) return std::nullopt;
  const std::int64_t stamp_ns = recorded.frame.stamp_ns;
  const TrackCourse& track = world.vehicle_course();
  const Alignment& alignment = world.alignment();
  const double vehicle_s_m = world.VehicleChainage_m(stamp_ns);
  const bool is_along = world.WorldFromVehicle(stamp_ns).linear().col(0).dot(
                            track.WorldFromTrack(alignment, vehicle_s_m).linear().col(0)) > 0.0;
  TrackStretch stretch{.alignment = alignment,
                       .track = track,
                       .from_s_m = vehicle_s_m - (is_along ? behind_m : ahead_m),
                       .to_s_m = vehicle_s_m + (is_along ? ahead_m : behind_m),
                       .sensor_from_world = recorded.frame.world_from_sensor.inverse()};
  stretch.from_s_m = std::max(stretch.from_s_m, track.begin_s_m());
  stretch.to_s_m = std::min(stretch.to_s_m, track.end_s_m());
  if (!(stretch.from_s_m < stretch.to_s_m)) return std::nullopt;
  return stretch;
}

constexpr Rgb kTrackAxisRgb = kYellow;
constexpr double kTickStep_m = 10.0;
constexpr int kTicksPerWord = 5;
// Half the lengths of the ticks: inside the rails, and as wide as the sleepers.
constexpr double kTick_m = 0.5;
constexpr double kLongTick_m = 1.3;

constexpr Rgb kClearSpaceRgb = kReddishPurple;
constexpr double kRingStep_m = 10.0;

/// The corners of the clear space at a chainage: up the left side and down the right one.
std::vector<Vector3> ClearSpaceRing(const TrackStretch& stretch,
                                    const std::vector<HalfWidth>& half_widths,
                                    std::optional<double> contact_height_m,
                                    double s_m) {
  const Transform sensor_from_track = stretch.SensorFromTrack(s_m);
  const TrackBend bend = BendAt(stretch.track, stretch.alignment, s_m);
  std::vector<Vector3> corners;
  for (const HalfWidth& row : ClearSpace(half_widths, contact_height_m, bend, 1.0)) {
    corners.emplace_back(sensor_from_track * Vector3(0.0, row.half_width_m, row.height_m));
  }
  const std::vector<HalfWidth> right = ClearSpace(half_widths, contact_height_m, bend, -1.0);
  for (std::size_t i = right.size(); i-- > 0;) {
    corners.emplace_back(sensor_from_track *
                         Vector3(0.0, -right[i].half_width_m, right[i].height_m));
  }
  return corners;
}

}  // namespace

std::string ChainageText(double s_m) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "km %.3f", s_m * 1e-3);
  return text.data();
}

std::vector<double> WholeChainages_m(double from_s_m, double to_s_m, double step_m) {
  std::vector<double> chainages_m;
  for (double step = std::ceil(from_s_m / step_m); step * step_m <= to_s_m; step += 1.0) {
    chainages_m.push_back(step * step_m);
  }
  return chainages_m;
}

Overlay DrawTrackAxis(const Surroundings& surroundings, const RecordedFrame& recorded) {
  Overlay drawing;
  const std::optional<TrackStretch> stretch =
      StretchAbout(*surroundings.world, recorded, kAxisBehind_m, kAxisAhead_m);
  if (!stretch) return drawing;
  std::vector<Vector3> axis;
  for (const double s_m : stretch->LineChainages_m()) {
    axis.emplace_back(stretch->SensorFromTrack(s_m).translation());
  }
  AddPolyline(axis, kTrackAxisRgb, drawing);
  for (const double s_m : WholeChainages_m(stretch->from_s_m, stretch->to_s_m, kTickStep_m)) {
    const bool is_long = std::llround(s_m / kTickStep_m) % kTicksPerWord == 0;
    const Transform sensor_from_track = stretch->SensorFromTrack(s_m);
    const double half_m = is_long ? kLongTick_m : kTick_m;
    const Vector3 left = sensor_from_track * Vector3(0.0, half_m, 0.0);
    AddSegment(left, sensor_from_track * Vector3(0.0, -half_m, 0.0), kTrackAxisRgb, drawing);
    if (is_long) AddWord(left, ChainageText(s_m), kTrackAxisRgb, drawing);
  }
  return drawing;
}

Overlay DrawClearSpace(const Surroundings& surroundings, const RecordedFrame& recorded) {
  Overlay drawing;
  const RailWorld& world = *surroundings.world;
  const std::optional<TrackStretch> stretch =
      StretchAbout(world, recorded, kClearSpaceBehind_m, kClearSpaceAhead_m);
  if (!stretch) return drawing;
  const std::optional<double> contact_height_m =
      ContactHeightOver_m(world.vehicle_track(), surroundings.scenario.world.catenary);
  const std::vector<HalfWidth> half_widths = ClearHalfWidths(surroundings.scenario.world);
  for (const double s_m : WholeChainages_m(stretch->from_s_m, stretch->to_s_m, kRingStep_m)) {
    std::vector<Vector3> ring = ClearSpaceRing(*stretch, half_widths, contact_height_m, s_m);
    ring.push_back(ring.front());
    AddPolyline(ring, kClearSpaceRgb, drawing);
  }
  std::vector<Vector3> last;
  for (const double s_m : stretch->LineChainages_m()) {
    const std::vector<Vector3> corners =
        ClearSpaceRing(*stretch, half_widths, contact_height_m, s_m);
    for (std::size_t i = 0; i < std::min(last.size(), corners.size()); ++i) {
      AddSegment(last[i], corners[i], kClearSpaceRgb, drawing);
    }
    last = corners;
  }
  return drawing;
}

}  // namespace railcast
