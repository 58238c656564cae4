#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/rail/base/world_faults.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/network.h"
#include "railcast/structures.h"
#include "railcast/world_spec.h"

namespace railcast {

/// A world's tracks with their courses, in the same order. Both must outlive it.
struct WorldTracks {
  const WorldSpec& world;
  std::span<const TrackCourse> courses;

  /// The course of the track of that name; null if there is none.
  [[nodiscard]] const TrackCourse* CourseOf(const std::string& name) const {
    const std::optional<std::size_t> index = TrackIndex(world, name);
    return index ? &courses[*index] : nullptr;
  }
};

/// The track of that name; null if there is none.
[[nodiscard]] const TrackSpec* FindTrack(const WorldSpec& world, const std::string& name);

/// Minimum distance between the axes of tracks that run side by side.
inline constexpr double kLeastTrackDistance_m = 3.0;

/// Most cant where tracks cross: the rails of an acute frog differ by 1.4 mm then.
inline constexpr double kMostCantAtCrossing_rad = 1e-3;

/// Tracks of which one runs this close to the next share a tunnel: nearer than this, one with a
/// lining of its own, of 5.1 m radius and 0.5 m thick, would have it in the gauge of the other,
/// which is 1.575 m wide to either side and leans over by 0.18 m at half the lining's height with a
/// cant of 150 mm.
inline constexpr double kSharedTunnel_m = 7.4;
/// Tracks of which one runs this close to the next share a bridge.
inline constexpr double kSharedBridge_m = 7.0;

/// The axes of the outermost of several tracks, left of the axis of one of them.
struct TrackSpread {
  double right_m{};  ///< At most 0.
  double left_m{};   ///< At least 0.

  [[nodiscard]] double middle_m() const { return 0.5 * (right_m + left_m); }
  [[nodiscard]] double half_width_m() const { return 0.5 * (left_m - right_m); }
};

/// The tracks that a structure along a stretch has room for: its own and, one after another, those
/// that run somewhere along the stretch within `gap_m` of one of them.
[[nodiscard]] TrackSpread SpreadOf(const WorldTracks& tracks,
                                   const StretchSpec& stretch,
                                   double gap_m);

/// Properties of the line that the rules below need.
struct LineMeasures {
  double length_m{};
  double tightest_radius_m{};
};

/// A line with the courses of its tracks; those with faults are absent.
struct LineOfTracks {
  LineMeasures measures;
  std::span<const std::optional<TrackCourse>> courses;
};

/// The pointer of a track of the world's: "/world/tracks/2".
[[nodiscard]] std::string TrackPointer(const TrackSpec& track, const WorldSpec& world);

/// A reference to a place on a track, with the pointers of its values.
struct TrackPlace {
  std::string track_pointer;
  std::string chainage_pointer;
  const std::string& track;
  double s_m{};
};

/// Checks that the track exists and that the place lies on it.
/// @return The track; null if it is unknown.
const TrackSpec* CheckTrackPlace(const WorldSpec& world,
                                 const TrackPlace& place,
                                 const LineOfTracks& line,
                                 WorldFaults& faults);

/// The chainages that a track has.
struct TrackExtent {
  double begin_s_m{};
  double end_s_m{};
};

/// The extent of a track, as far as it is known.
[[nodiscard]] std::optional<TrackExtent> ExtentOf(const WorldSpec& world,
                                                  const TrackSpec& track,
                                                  const LineOfTracks& line,
                                                  const WorldFaults& faults);

/// What exists for the standard gauge only. The rule says so far that it does.
struct OfStandardGauge {
  std::string place;
  std::string rule;
  std::string found;
};
/// Reports it on a line of another gauge.
void CheckFitsGauge(const WorldSpec& world, const OfStandardGauge& thing, WorldFaults& faults);

/// Reports a rail vehicle on a line of another gauge than its wheels. Faults begin with `pointer`.
void CheckWheelsFit(const WorldSpec& world,
                    const ObjectType& type,
                    const std::string& pointer,
                    WorldFaults& faults);

}  // namespace railcast
