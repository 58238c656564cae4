#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/rail/line/network.h"
#include "core/rail/world_faults.h"
#include "railcast/rail_world.h"

namespace railcast {

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

/// Minimum distance between the axes of tracks that run side by side.
inline constexpr double kLeastTrackDistance_m = 3.0;

/// Checks a world and its vehicle for consistency with each other and with the line. Faults are
/// lines like `/world/objects/3/track: must be one of "main", "siding" (got "sidng")`. Speed
/// profiles are checked separately (SpeedProfile), and so is the network (DraftNetwork,
/// CheckNetwork).
/// @param line Infinite measures if the line is unknown.
void CheckWorld(const WorldSpec& world,
                const VehicleSpec& vehicle,
                const LineOfTracks& line,
                WorldFaults& faults);

/// Checks the place of one object. Faults are lines that begin with `pointer`.
void CheckObject(const WorldSpec& world,
                 const ObjectSpec& object,
                 const std::string& pointer,
                 const LineOfTracks& line,
                 WorldFaults& faults);

/// Reports a rail vehicle on a line of another gauge than its wheels. Faults begin with `pointer`.
void CheckWheelsFit(const WorldSpec& world,
                    const ObjectType& type,
                    const std::string& pointer,
                    WorldFaults& faults);

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

/// The track of that name; null if there is none.
[[nodiscard]] const TrackSpec* FindTrack(const WorldSpec& world, const std::string& name);

}  // namespace railcast
