#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/rail/line/piecewise_linear.h"
#include "core/rail/line/plan_course.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/turnout_place.h"

namespace railcast {

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
