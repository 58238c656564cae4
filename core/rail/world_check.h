#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>

#include "core/base/error.h"
#include "core/base/unknown_places.h"
#include "railcast/rail_world.h"

namespace railcast {

/// Properties of the line that the rules below need.
struct LineMeasures {
  double length_m{};
  double tightest_radius_m{};
};

/// Faults of a world, and the values that are unknown because of these or earlier faults. Pointers
/// refer to the scenario: "/world/..." and "/vehicle/...".
struct WorldFaults {
  ErrorList errors;
  UnknownPlaces unknown;

  /// Reports a fault of the value at `pointer`, which becomes unknown.
  void Add(const std::string& pointer, const std::string& rule, const std::string& value = "") {
    errors.Add({pointer, rule, value});
    unknown.Add(pointer);
  }
  [[nodiscard]] bool AreKnown(std::initializer_list<std::string> pointers) const {
    return std::all_of(pointers.begin(), pointers.end(),
                       [&](const std::string& pointer) { return unknown.IsKnown(pointer); });
  }
};

/// Minimum distance between the axes of tracks that run side by side.
inline constexpr double kLeastTrackDistance_m = 3.0;

/// Checks a world and its vehicle for consistency with each other and with the line. Faults are
/// lines like `/world/objects/3/track: must be one of "main", "siding" (got "sidng")`. Speed
/// profiles are checked separately (SpeedProfile).
/// @param line Infinite measures if the line is unknown.
void CheckWorld(const WorldSpec& world,
                const VehicleSpec& vehicle,
                const LineMeasures& line,
                WorldFaults& faults);

/// Checks the place of one object. Faults are lines that begin with `pointer`.
void CheckObject(const WorldSpec& world,
                 const ObjectSpec& object,
                 const std::string& pointer,
                 const LineMeasures& line,
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
                                 const LineMeasures& line,
                                 WorldFaults& faults);

/// The track of that name; null if there is none.
[[nodiscard]] const TrackSpec* FindTrack(const WorldSpec& world, const std::string& name);

}  // namespace railcast
