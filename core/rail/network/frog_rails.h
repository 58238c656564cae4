#pragma once

#include <functional>

#include "core/rail/base/chainage_range.h"
#include "core/rail/line/track_course.h"

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
  std::function<double(double s_m)> width_m;  ///< Of what is left behind the gauge face.
  bool begins_openly{};  ///< Whether its end at the lower chainage shows and must be closed.
  bool ends_openly{};
};

/// Dimensions of frogs and what guards them, in which turnouts and crossings agree. The flangeways
/// are those of common practice (docs/world.md).
inline constexpr double kFrogFlangeway_m = 0.044;  ///< Between the nose and the wing rails.
inline constexpr double kCheckFlangeway_m = 0.041;
inline constexpr double kNoseTipWidth_m = 0.012;  ///< Of the nose where it begins to carry.
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

/// One of the two rails that cross in a frog with one nose. Distances count along the tracks from
/// `from_s_m` on, the throat lies before the nose.
struct FrogRail {
  GaugeLine own;
  GaugeLine other;
  bool follows_branch{};  ///< Whether its track is the second of the two.
  bool is_left{};         ///< Which rail of its track it is.
  double from_s_m{};
  bool opens_ahead{};  ///< Whether distances count with rising chainage.

  [[nodiscard]] double ChainageOf_m(double along_m) const;
  [[nodiscard]] double AlongOf_m(double plane_s_m) const;
  /// Side to which the rail would be moved away from what it lies against, +1 left, -1 right.
  [[nodiscard]] double OpenSide() const { return is_left ? -1.0 : 1.0; }
  /// Distance of the two gauge lines, positive in front of the frog.
  [[nodiscard]] double Spread_m(double plane_s_m) const;
  /// The range between two distances, in the frames of this rail's track.
  [[nodiscard]] ChainageRange FramesBetween(double from_m, double to_m) const;

  /// The whole rail between two distances.
  [[nodiscard]] TurnoutRail Piece(RailRole role, double from_m, double to_m) const;
  /// Goes on from the throat beside the other rail, a flangeway off, and opens at its end. It
  /// follows the other track's course, with its own section.
  [[nodiscard]] TurnoutRail Wing(double throat_m, double end_m) const;
  /// Half of the nose, planed where the other half is.
  [[nodiscard]] TurnoutRail Nose(double nose_m, double end_m) const;
  /// Beside the other rail of this rail's track, opposite the frog.
  [[nodiscard]] CheckRail CheckRailOpposite(double nose_m) const;
  /// Closes the end of a piece that is nearer to or farther from `from_s_m`.
  void ShowEnd(TurnoutRail& rail, bool is_far_end) const;
};

}  // namespace railcast
