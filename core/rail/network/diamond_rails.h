#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/rail/base/chainage_range.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/frog_rails.h"
#include "core/rail/network/network.h"

namespace railcast {

/// A diamond crossing with the courses of its two tracks.
struct DiamondCourses {
  const DiamondSite& site;
  const TrackCourse& first;
  const TrackCourse& second;
};

/// Farther from the middle than this, no part of a crossing is looked for.
inline constexpr double kDiamondReach_m = 60.0;

/// Chainages, in the plane of chainage and offset, at which something begins or ends on one of the
/// four rails of a diamond. Each passes an acute frog, in which it meets the other side's rail of
/// the other track, and an obtuse one, in which it meets the same side's rail.
struct CrossedRailPlaces {
  double whole_s_m{};   ///< Outside the acute frog, where the rail is whole again.
  double nose_s_m{};    ///< Where the acute frog's nose begins.
  double acute_s_m{};   ///< Where the gauge lines cross at the acute angle.
  double throat_s_m{};  ///< Inside the acute frog, where a flangeway is between both rails.
  double planed_s_m{};  ///< From here on, the rail is planed towards the obtuse frog ...
  double tip_s_m{};     ///< ... and ends here.
  double obtuse_s_m{};  ///< Where the gauge lines cross at the obtuse angle.
  double clear_s_m{};   ///< Behind the obtuse frog, where the rail no longer belongs to it.
};

/// The places on one rail; absent if they do not all lie within kDiamondReach_m of the middle.
[[nodiscard]] std::optional<CrossedRailPlaces> PlacesOn(const DiamondCourses& diamond,
                                                        bool on_second,
                                                        bool is_left);

/// All pieces of the four rails, in place of what DiamondExtent says.
/// @pre PlacesOn() finds the places on all of them.
[[nodiscard]] std::vector<TurnoutRail> RailsOf(const DiamondCourses& diamond);

/// The check rails opposite the acute frogs, and those in the obtuse ones.
[[nodiscard]] std::vector<CheckRail> CheckRailsOf(const DiamondCourses& diamond);

/// The chainages over which rails are replaced by the pieces of the diamond, and both tracks'
/// sleepers by long bearers.
struct DiamondExtent {
  std::array<ChainageRange, 2> first_rails;   ///< Of the first track: its right and left rail.
  std::array<ChainageRange, 2> second_rails;  ///< As above, of the second track.
  ChainageRange bearers;
};

/// A diamond and what it replaces, found once for the whole line.
struct LaidDiamond {
  DiamondSite site;
  DiamondExtent extent;
};
[[nodiscard]] std::vector<LaidDiamond> LayDiamonds(const Network& network);

}  // namespace railcast
