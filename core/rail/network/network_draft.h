#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/rail/base/world_faults.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/network.h"
#include "core/rail/network/turnout_place.h"
#include "railcast/world_spec.h"

namespace railcast {

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

}  // namespace railcast
