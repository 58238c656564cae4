#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/rail/base/world_faults.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/network.h"
#include "core/rail/network/turnout_place.h"
#include "railcast/alignment.h"
#include "railcast/world_spec.h"

namespace railcast {

/// The tracks of all yards of a world.
///
/// A yard's lead, NAME_lead, leaves its turnout and runs straight on at the turnout's angle. In it
/// lie the turnouts of the tracks NAME_1, NAME_2 and so on, the first of which is nearest to the
/// track that the yard branches off. They lead back, so that all tracks are parallel, `spacing_m`
/// apart. Behind the last turnout the lead turns back in an arc of the turnout's radius and is the
/// last of the yard's tracks. Each track ends `usable_length_m` behind its fouling point, where
/// its axis is kFoulingDistance_m from that of its neighbour.
[[nodiscard]] std::vector<TrackSpec> TracksOfYards(const WorldSpec& world);

/// The world with the tracks of its yards behind its own, and without yards.
[[nodiscard]] WorldSpec WithTracksOfYards(const WorldSpec& world);

/// Faults of yards themselves: names, missing sides, and spacings in which the turnouts of a ladder
/// have no room. Pointers begin with "/world/yards/".
void CheckYards(const WorldSpec& world, ErrorList& errors);

/// A fault of a track of WithTracksOfYards() as one of its yard; others are unchanged.
[[nodiscard]] Fault FaultOfYard(const WorldSpec& world, const Fault& fault);

/// Makes what can be made of a network and adds all faults found in doing so. Values that `faults`
/// marks as unknown are skipped.
/// @param length_m Of the line; may be infinite.
[[nodiscard]] NetworkDraft DraftNetwork(const WorldSpec& world,
                                        double length_m,
                                        WorldFaults& faults);

/// @throws InputError with the faults that DraftNetwork() finds.
[[nodiscard]] Network MakeNetwork(const WorldSpec& world, double length_m);

/// @pre The draft was made without faults.
[[nodiscard]] Network Completed(NetworkDraft draft);

/// A track that is not parallel to the alignment, and the turnouts at its ends.
struct IndependentTrack {
  std::string pointer;
  const TrackSpec& spec;
  const std::optional<TurnoutPlace>& begin;
  const std::optional<TurnoutPlace>& end;
  double line_length_m{};
};

/// What could be made of it. Turnouts lack their `branch`.
struct IndependentCourse {
  std::optional<TrackCourse> course;
  std::optional<TurnoutSite> begin;
  std::optional<TurnoutSite> end;
};

/// Makes the course of such a track by the rules of Network and adds all faults found.
[[nodiscard]] IndependentCourse MakeIndependentCourse(const IndependentTrack& track,
                                                      WorldFaults& faults);

/// The flattest and the steepest angle at which tracks may cross, as the n of 1:n.
inline constexpr double kFlattestDiamond = 20.0;
inline constexpr double kSteepestDiamond = 4.0;

/// All chainages at which the axes of two tracks cross, in rising order.
/// @pre One of them ends.
[[nodiscard]] std::vector<double> CrossingPlaces(const TrackCourse& one, const TrackCourse& other);

/// Finds the places that WorldSpec::diamond_crossings names and adds them to the network, which has
/// its courses and turnouts. Adds a fault where a track is unknown, where the tracks do not cross
/// within 5 m of the chainage, where their angle is flatter or steeper than allowed, where one of
/// them ends in the crossing, and where the crossing lies in a turnout or in another crossing.
void FindDiamonds(const WorldSpec& world, NetworkDraft& network, WorldFaults& faults);

/// The chainages about a diamond at which its tracks are less than `distance_m` apart, as far as
/// both run; the diamond itself if they do not part.
[[nodiscard]] ChainageRange CloseTo(const DiamondSite& diamond,
                                    const NetworkDraft& network,
                                    double distance_m);

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
