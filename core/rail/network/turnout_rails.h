#pragma once

#include <vector>

#include "core/rail/base/chainage_range.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/frog_rails.h"
#include "core/rail/network/network.h"

namespace railcast {

/// A turnout with the courses of its two tracks.
struct TurnoutCourses {
  const TurnoutSite& site;
  const TrackCourse& through;
  const TrackCourse& branch;
};

/// The chainages over which a track's inner rail is replaced by the pieces of the turnout, and both
/// tracks' sleepers by long bearers.
struct TurnoutExtent {
  ChainageRange through_rail;
  ChainageRange branch_rail;
  ChainageRange bearers;
};

/// The frog's theoretical point, where the gauge lines of the two inner rails cross.
struct FrogPoint {
  double through_s_m{};  ///< Chainage of the through track's frame in which it lies.
  double branch_s_m{};   ///< As above, of the branch.
  double angle_rad{};    ///< Between the two gauge lines.
};

/// Dimensions of the blades, in which German turnouts of all sizes agree, by common practice
/// (docs/world.md).
inline constexpr double kBladeOpening_m = 0.160;  ///< At the tip of the open blade.
inline constexpr double kBladeTipWidth_m = 0.003;
inline constexpr double kHeelSpread_m = 0.200;  ///< Between gauge faces, where blades end.

/// Distance of two tracks' axes up to which they share bearers: beyond it, the sleepers of both lie
/// side by side with 0.1 m between them.
inline constexpr double kBearerSpread_m = 2.7;

/// Place of the frog. @pre The rails cross before the branch ends.
[[nodiscard]] FrogPoint FrogOf(const TurnoutCourses& turnout);

/// All pieces of both inner rails, in place of what TurnoutExtent says.
[[nodiscard]] std::vector<TurnoutRail> RailsOf(const TurnoutCourses& turnout);

[[nodiscard]] std::vector<CheckRail> CheckRailsOf(const TurnoutCourses& turnout);

[[nodiscard]] TurnoutExtent ExtentOf(const TurnoutCourses& turnout);

/// A turnout and what it replaces, found once for the whole line.
struct LaidTurnout {
  TurnoutSite site;
  TurnoutExtent extent;
};
[[nodiscard]] std::vector<LaidTurnout> LayTurnouts(const Network& network);

}  // namespace railcast
