#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/rail/base/world_faults.h"
#include "core/rail/network/network.h"
#include "railcast/alignment.h"

namespace railcast {

/// A section in which a turnout keeps two tracks together.
struct JoinedSection {
  std::size_t track{};
  std::size_t branch{};
  double begin_s_m{};
  double end_s_m{};
};

/// The section of a turnout: from its beginning to where its tracks are kLeastTrackDistance_m
/// apart, or to its end if they never are.
[[nodiscard]] JoinedSection JoinedSectionOf(const TrackCourse& track,
                                            const TrackCourse& branch,
                                            const TurnoutSite& turnout);

/// Whether turnouts keep two tracks together at a chainage, also by way of others.
[[nodiscard]] bool AreJoined(std::span<const JoinedSection> sections,
                             std::size_t one,
                             std::size_t other,
                             double s_m);

/// A place where two tracks are too close.
struct ClosePlace {
  double s_m{};
  double distance_m{};
  bool tracks_cross = false;  ///< Whether they are too close with either of them on the left.
};

/// Two tracks of a network by their numbers.
struct TrackPair {
  struct Track {
    std::size_t index{};
    const TrackCourse& course;
  };
  Track one;
  Track other;
};

/// Where two tracks that no turnout joins are closest to each other, by samples at most 1 m apart.
/// Absent if they are kLeastTrackDistance_m apart everywhere.
[[nodiscard]] std::optional<ClosePlace> FindClosePlace(std::span<const JoinedSection> joined,
                                                       const TrackPair& pair);

/// Checks the courses of the tracks that are not parallel to the alignment: offsets within the
/// ground's half width, radii of at least kSmallestRadius_m, and at least kLeastTrackDistance_m
/// from every other track. Tracks that a turnout joins may be closer from its beginning to where
/// the branch has got that far, and so may all tracks that such turnouts join there; and tracks
/// that cross, which must be without cant there.
/// @param alignment Absent if unknown; radii are not checked then.
void CheckNetwork(const WorldSpec& world,
                  const NetworkDraft& network,
                  const std::optional<Alignment>& alignment,
                  WorldFaults& faults);

}  // namespace railcast
