#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/base/world_faults.h"
#include "core/rail/line/piecewise_linear.h"
#include "core/rail/line/plan_course.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/network.h"
#include "railcast/world_spec.h"

namespace railcast {

/// The axes of a turnout with a straight main track. The diverging axis is an arc that touches the
/// main axis at the turnout's beginning and turns by the angle; then it runs straight to the
/// turnout's end. Both axes are equally long from the point where their tangents meet to the end.
struct TurnoutGeometry {
  double radius_m{};   ///< Radius of the arc of the diverging axis.
  double angle_rad{};  ///< atan(1 / n) for a turnout 1:n.
  /// From the beginning to the point where the tangents meet: R tan(angle / 2).
  double tangent_m{};
  double length_m{};  ///< From the beginning to the end, along the main axis.

  /// Length of the arc of the diverging axis.
  [[nodiscard]] double arc_m() const { return radius_m * angle_rad; }
  /// Length of the straight behind the arc.
  [[nodiscard]] double straight_m() const { return length_m - 2.0 * tangent_m; }
};

/// The standard turnouts of docs/world.md: 1:9-300, 1:12-500 and 1:14-760 end where the arc
/// does. The arc of 1:9-190 ends before its crossing, and it is as long behind the point where the
/// tangents meet as a 1:9-300, whose crossing it shares.
[[nodiscard]] TurnoutGeometry GeometryOf(TurnoutType type);

/// A turnout as specified, on a track whose course is known.
struct TurnoutPlace {
  std::string pointer;  ///< Pointer of its spec.
  TurnoutSpec spec;
  std::size_t track{};
  TrackCourse course;  ///< Course of that track.
  TurnoutGeometry geometry;
  bool opens_ahead{};
};

/// The chainage of a track where a turnout that begins at `s_m` ends.
[[nodiscard]] double TurnoutEnd_m(const TurnoutPlace& place, double s_m);

/// Curvature of the track through a turnout that begins at `s_m`, in the plane of chainage and
/// offset, by the length from the turnout's beginning on: one piece where it is the same
/// throughout, else many. Returns nothing and adds a fault if the track ends within the turnout.
[[nodiscard]] std::optional<std::vector<LinearPiece>> CurvatureThrough(const TurnoutPlace& place,
                                                                       double s_m,
                                                                       WorldFaults& faults);

/// Distance of the axes of two tracks that join at their fouling point, where the marker stands
/// (in German the Grenzzeichen).
inline constexpr double kFoulingDistance_m = 3.5;

/// The chainage at which the branch of a turnout is `distance_m` away from the track in which the
/// turnout lies, measured across the alignment; absent if it never is.
[[nodiscard]] std::optional<double> ClearChainage_m(const TrackCourse& track,
                                                    const TrackCourse& branch,
                                                    const TurnoutSite& turnout,
                                                    double distance_m);

[[nodiscard]] bool AreNamesKnown(const WorldSpec& world, const WorldFaults& faults);
/// Reports a name that no track of the world has, unless the names of some are unknown.
void AddUnknownTrack(const WorldSpec& world,
                     const std::string& pointer,
                     const std::string& name,
                     WorldFaults& faults);

/// A length to the millimetre.
[[nodiscard]] std::string MetresText(double length_m);
/// Text such as "from 0 to 1000 m", or "from 0 m on" if the end is infinite.
[[nodiscard]] std::string StretchText(double begin_s_m, double end_s_m);

/// A way out of a turnout, in a plane whose x is the chainage, or minus the chainage if it is
/// mirrored, and whose y is the offset. It grows at its end.
class BranchCourse {
 public:
  /// Starts on another track, with its direction.
  /// @param is_mirrored Whether it runs towards falling chainage.
  BranchCourse(const TrackCourse& track, double s_m, bool is_mirrored);
  /// Starts anywhere, towards rising chainage.
  explicit BranchCourse(const PlanPoint& start);

  /// Appends the diverging axis of a turnout.
  /// @param side 1 if it leaves to the left (towards rising chainage), else -1.
  /// @param through Curvature of the track in which the turnout lies (CurvatureThrough).
  void AddTurnout(const TurnoutGeometry& turnout,
                  double side,
                  const std::vector<LinearPiece>& through);
  /// Appends the diverging axis of the turnout `way_out`, whose beginning is its first point, from
  /// the turnout's end to its beginning.
  void AddBackwards(const BranchCourse& way_out);
  /// Appends the diverging axis of a turnout in a track of one curvature, from its end to its
  /// beginning.
  /// @param side 1 if the axis bends to the left (towards rising chainage) there, else -1.
  /// @param main_per_m Curvature of the track in which the turnout lies.
  void AddTurnoutBackwards(const TurnoutGeometry& turnout, double side, double main_per_m);
  /// Appends an element; nothing if it is too short to matter.
  void Add(double length_m, double begin_per_m, double end_per_m);
  /// Appends a straight and an arc that turns back, so that the course then runs at the offset
  /// `d_m` and parallel to the alignment.
  /// @return The offset that is nearest to `d_m` and can be reached, if `d_m` cannot.
  [[nodiscard]] std::optional<double> AddReturnTo(double d_m, double radius_m);

  [[nodiscard]] const PlanPoint& end() const { return end_; }
  /// The end in the plane of chainage and offset, heading towards rising chainage.
  [[nodiscard]] PlanPoint EndTowardsRising() const {
    return is_mirrored_ ? PlanPoint{-end_.x_m, end_.y_m, -end_.heading_rad, 0.0} : end_;
  }
  [[nodiscard]] double end_s_m() const { return is_mirrored_ ? -end_.x_m : end_.x_m; }
  /// The steepest heading so far.
  [[nodiscard]] double steepest_rad() const { return steepest_rad_; }

  /// The whole course as a piece between two chainages.
  [[nodiscard]] CoursePiece Piece(double begin_s_m, double end_s_m) const;

 private:
  PlanPoint start_;
  PlanPoint end_;
  bool is_mirrored_;
  double length_m_ = 0.0;
  double steepest_rad_ = 0.0;
  std::vector<LinearPiece> curvature_;
};

}  // namespace railcast
