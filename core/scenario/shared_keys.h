#pragma once

#include <string>
#include <vector>

#include "core/scenario/archive.h"

namespace railcast {

// Keys and limits that several descriptions have.

[[nodiscard]] inline Limits ChainageLimits() {
  return Within(0, 1e7);
}
/// Limits of the chainage of an object or of a beginning. A moving object may start before the
/// beginning of the line.
[[nodiscard]] inline Limits PlaceLimits() {
  return Within(-1e7, 1e7);
}
/// Double precision resolves such coordinates to 0.02 um.
[[nodiscard]] inline Limits CoordinateLimits() {
  return Within(-1e8, 1e8);
}
[[nodiscard]] inline Limits HeadingLimits() {
  return Within(-360, 360);
}

/// The range gate, of a sensor or of a detector.
template <class Spec>
void DescribeRange(Archive& a, Spec& s) {
  a.Optional("range_min_m", s.range_min_m,
             "Least range; nearer surfaces block the beam and give no point.", Within(0, 10'000));
  a.Optional("range_max_m", s.range_max_m, "Greatest range; farther surfaces give no point.",
             PositiveUpTo(10'000));
  a.Ensure({"range_min_m", "range_max_m"}, s.range_min_m < s.range_max_m, "must be < range_max_m");
}

/// The keys that all structures have.
template <class Structure>
void DescribeNameAndTrack(Archive& a, Structure& s, KeyDoc track_doc) {
  a.Required("name", s.name, "Unique among the structures.", NonEmptyString());
  a.Optional("track", s.track, track_doc);
}

/// The tracks that a vehicle or object follows: one, or a route over several.
void DescribeTracks(Archive& a, std::string& track, std::vector<std::string>& route);

}  // namespace railcast
