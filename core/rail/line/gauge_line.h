#pragma once

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

}  // namespace railcast
