#pragma once

#include <functional>
#include <vector>

#include "core/rail/chainage_range.h"
#include "core/rail/line/network.h"
#include "core/rail/line/track_course.h"

namespace railcast {

/// A turnout with the courses of its two tracks.
struct TurnoutCourses {
  const TurnoutSite& site;
  const TrackCourse& through;
  const TrackCourse& branch;
};

/// What a piece of rail in a turnout belongs to.
enum class RailRole { kClosure, kBlade, kWing, kNose };

/// A piece of rail of a turnout: the section of a track's left or right rail, swept along the
/// track's course, pushed aside and planed.
struct TurnoutRail {
  RailRole role{};
  bool follows_branch{};  ///< Whose course it follows.
  bool is_left{};         ///< Whose section it has: of the left or of the right rail.
  ChainageRange range;
  std::function<double(double s_m)>
      aside_m;  ///< From the rail's place in its track, left positive.
  std::function<double(double s_m)> width_m;  ///< Of what is left behind the gauge face.
  bool begins_openly{};  ///< Whether its end at the lower chainage shows and must be closed.
  bool ends_openly{};
};

/// A check rail opposite the frog: guards the back of the wheels on one stock rail.
struct CheckRail {
  bool follows_branch{};
  bool is_left{};  ///< Which rail of the track it stands beside.
  ChainageRange range;
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

/// Dimensions of the moving and of the broken parts, in which German turnouts of all sizes agree.
/// The opening of the blades and the flangeways are those of EBO Anlage 2 and of common practice
/// (docs/world.md).
inline constexpr double kBladeOpening_m = 0.160;  ///< At the tip of the open blade.
inline constexpr double kBladeTipWidth_m = 0.003;
inline constexpr double kHeelSpread_m = 0.200;     ///< Between gauge faces, where blades end.
inline constexpr double kFrogFlangeway_m = 0.044;  ///< Between the nose and the wing rails.
inline constexpr double kCheckFlangeway_m = 0.041;
inline constexpr double kNoseTipWidth_m = 0.012;  ///< Of the nose where it begins to carry.

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
