#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>

#include "core/base/error.h"
#include "core/base/unknown_places.h"
#include "core/rail/world_spec.h"

namespace railcast {

/// What the rules below need to know of the line.
struct LineMeasures {
  double length_m{};
  double tightest_radius_m{};
};

/// Faults of a world, and what is not known of it because of these and earlier ones. Pointers are
/// those of a scenario: "/world/..." and "/vehicle/...".
struct WorldFaults {
  ErrorList errors;
  UnknownPlaces unknown;

  /// The value at `pointer` is faulty, and from now on unknown.
  void Add(const std::string& pointer, const std::string& rule) {
    errors.Add(pointer + ": " + rule);
    unknown.Add(pointer);
  }
  [[nodiscard]] bool AreKnown(std::initializer_list<std::string> pointers) const {
    return std::all_of(pointers.begin(), pointers.end(),
                       [&](const std::string& pointer) { return unknown.IsKnown(pointer); });
  }
};

/// Tracks that run beside each other are at least so far apart, from axis to axis.
inline constexpr double kLeastTrackDistance_m = 3.0;

/// Faults of a world and its vehicle against each other and the line, as lines like
/// `/world/objects/3/track: must be one of "main", "siding" (got "sidng")`. Speed profiles have
/// rules of their own (SpeedProfile).
/// @param line Infinite where the line is not known.
void CheckWorld(const WorldSpec& world,
                const VehicleSpec& vehicle,
                const LineMeasures& line,
                WorldFaults& faults);

/// Faults of one object's place, as lines that begin with `pointer`.
void CheckObject(const WorldSpec& world,
                 const ObjectSpec& object,
                 const std::string& pointer,
                 const LineMeasures& line,
                 WorldFaults& faults);

/// The track of that name, or null.
[[nodiscard]] const TrackSpec* FindTrack(const WorldSpec& world, const std::string& name);

}  // namespace railcast
