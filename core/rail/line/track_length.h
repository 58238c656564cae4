#pragma once

#include <vector>

#include "core/rail/line/track_course.h"
#include "railcast/alignment.h"

namespace railcast {

/// The length of a track's axis in space as a function of chainage. The two differ because chainage
/// is that of the alignment, in plan: beside a curve of radius R they do by offset / R, over a
/// gradient of 40 permil by 0.8 permil.
///
/// Between its samples every metre, the length is that of the chord: too short by 1 / (24 R^2) of
/// itself, 0.04 mm over 20 m at R = 150 m. Beyond the ends of the track, chainage is length.
class TrackLength {
 public:
  /// @pre The course has an end.
  TrackLength(const Alignment& alignment, const TrackCourse& course);
  /// Of a stretch of the course, whose ends take the place of the track's.
  TrackLength(const Alignment& alignment,
              const TrackCourse& course,
              double begin_s_m,
              double end_s_m);

  /// The chainage that lies `length_m` of track from another one, towards rising chainage if it is
  /// positive.
  [[nodiscard]] double MovedFrom(double s_m, double length_m) const;
  /// Of the track between its beginning and a chainage.
  [[nodiscard]] double UpTo(double s_m) const;
  [[nodiscard]] double total_m() const { return lengths_m_.back(); }

 private:
  double begin_s_m_{};
  double step_m_{};
  std::vector<double> lengths_m_;  ///< Up to each sample; strictly ascending.
};

}  // namespace railcast
