#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "core/rail/line/track_course.h"
#include "core/rail/network/network.h"

namespace railcast {

/// A place in the plane of chainage and offset.
struct PlanePlace {
  double s_m{};
  double d_m{};
};

/// The gauge line of one rail of a track in the plane of chainage and offset: half a gauge square
/// to its axis.
class GaugeLine {
 public:
  GaugeLine(TrackCourse course, bool is_left);

  /// The gauge face in the frame of the track at `s_m`.
  [[nodiscard]] PlanePlace At(double s_m) const;
  /// The frame of the track in which the gauge face lies at plane chainage `plane_s_m`.
  [[nodiscard]] double FrameAt_m(double plane_s_m) const;
  /// The offset of the gauge face at plane chainage `plane_s_m`.
  [[nodiscard]] double LateralAt_m(double plane_s_m) const;
  /// From one frame to the other of those in which the gauge face lies at two plane chainages.
  [[nodiscard]] ChainageRange FramesBetween(double one_s_m, double other_s_m) const;

 private:
  TrackCourse course_;
  double side_;
};

/// What a piece of rail in a turnout or a diamond crossing belongs to.
enum class RailRole { kClosure, kBlade, kWing, kNose };

/// A piece of rail of a turnout or a diamond crossing: the section of a track's left or right rail,
/// swept along the course of one of the two tracks, pushed aside and planed.
struct TurnoutRail {
  RailRole role{};
  bool follows_branch{};  ///< Whose course it follows; in a diamond, that of the second track.
  bool is_left{};         ///< Whose section it has: of the left or of the right rail.
  ChainageRange range;
  std::function<double(double s_m)>
      aside_m;  ///< From the rail's place in its track, left positive.
  std::function<double(double s_m)> width_m;  ///< Width of what is left behind the gauge face.
  bool begins_openly{};  ///< Whether its end at the lower chainage shows and must be closed.
  bool ends_openly{};
};

/// Dimensions of frogs and what guards them, in which turnouts and crossings agree. The flangeways
/// are those of common practice (docs/world.md).
inline constexpr double kFrogFlangeway_m = 0.044;  ///< Between the nose and the wing rails.
inline constexpr double kCheckFlangeway_m = 0.041;
inline constexpr double kNoseTipWidth_m = 0.012;  ///< Width of the nose where it begins to carry.
inline constexpr double kWingBeyondNose_m = 1.2;
inline constexpr double kNoseSpread_m =
    0.25;  ///< Where both rails are whole again behind the nose.

/// A rail beside another one, which guards the back of the wheels: opposite a frog, or in an obtuse
/// one.
struct CheckRail {
  bool follows_branch{};
  bool is_left{};  ///< Which rail of the track it stands beside.
  ChainageRange range;
  double flangeway_m = kCheckFlangeway_m;
  bool flares_at_begin = true;  ///< Whether it bends away from the rail at its lower chainage.
  bool flares_at_end = true;
};

/// A rail of a turnout or a diamond crossing that crosses a rail of the other track in a frog with
/// one nose. Distances count along the tracks from `from_s_m` on, the throat lies before the nose.
struct FrogRail {
  GaugeLine own;
  GaugeLine other;   ///< Which it crosses in the frog: on the other side of the other track.
  GaugeLine beside;  ///< On the same side of the other track: the stock rail, or in a diamond what
                     ///< it crosses in the obtuse frog.
  bool follows_branch{};  ///< Whether its track is the second of the two.
  bool is_left{};         ///< Which rail of its track it is.
  double from_s_m{};
  bool opens_ahead{};  ///< Whether distances count with rising chainage.

  [[nodiscard]] double ChainageOf_m(double along_m) const {
    return opens_ahead ? from_s_m + along_m : from_s_m - along_m;
  }
  [[nodiscard]] double AlongOf_m(double plane_s_m) const { return std::abs(plane_s_m - from_s_m); }
  /// Side to which the rail would be moved away from what it lies against, +1 left, -1 right.
  [[nodiscard]] double OpenSide() const { return is_left ? -1.0 : 1.0; }
  /// Distance of the two gauge lines, positive in front of the frog.
  [[nodiscard]] double Spread_m(double plane_s_m) const {
    return OpenSide() * (other.LateralAt_m(plane_s_m) - own.LateralAt_m(plane_s_m));
  }
  /// From `beside`: positive behind the tip of a blade, and before an obtuse frog.
  [[nodiscard]] double SpreadBeside_m(double plane_s_m) const {
    return OpenSide() * (own.LateralAt_m(plane_s_m) - beside.LateralAt_m(plane_s_m));
  }
  /// The range between two distances, in the frames of this rail's track.
  [[nodiscard]] ChainageRange FramesBetween(double from_m, double to_m) const {
    return own.FramesBetween(ChainageOf_m(from_m), ChainageOf_m(to_m));
  }

  /// The whole rail between two plane chainages.
  [[nodiscard]] TurnoutRail Piece(RailRole role, double one_s_m, double other_s_m) const;
  /// Goes on from the throat beside the other rail, a flangeway off, and opens at its end. It
  /// follows the other track's course, with its own section.
  [[nodiscard]] TurnoutRail Wing(double throat_m, double end_m) const;
  /// Half of the nose, planed where the other half is.
  [[nodiscard]] TurnoutRail Nose(double nose_m, double end_m) const;
  /// Beside the other rail of this rail's track, opposite the frog.
  [[nodiscard]] CheckRail CheckRailOpposite(double nose_m) const;
  /// Closes the end of a piece at which distances are least or greatest.
  void ShowEnd(TurnoutRail& rail, bool is_far_end) const;
};

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
  double branch_s_m{};   ///< Chainage of the branch's frame in which it lies.
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
  std::array<ChainageRange, 2> first_rails;   ///< The first track's right and left rail.
  std::array<ChainageRange, 2> second_rails;  ///< The second track's right and left rail.
  ChainageRange bearers;
};

/// A diamond and what it replaces, found once for the whole line.
struct LaidDiamond {
  DiamondSite site;
  DiamondExtent extent;
};
[[nodiscard]] std::vector<LaidDiamond> LayDiamonds(const Network& network);

}  // namespace railcast
