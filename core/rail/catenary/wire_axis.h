#pragma once

#include <cstddef>
#include <vector>

#include "core/rail/line/track_course.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/alignment.h"

namespace railcast {

/// What the wire of a track hangs above: its axis, and before its beginning and behind its end that
/// of the track which it leaves or joins in a turnout. The courses must outlive it.
class WireAxis {
 public:
  WireAxis(const WorldTracks& tracks, std::size_t track);

  /// Left of the alignment. Beyond a free end it stays.
  [[nodiscard]] double OffsetAt_m(double s_m) const;
  /// Above the alignment (TrackCourse::LiftAt).
  [[nodiscard]] double LiftAt_m(const Alignment& alignment, double s_m) const;

 private:
  struct Section {
    const TrackCourse* course{};
    double end_s_m{};  ///< Where the next one begins.
  };
  [[nodiscard]] const TrackCourse& CourseAt(double s_m) const;

  std::vector<Section> sections_;
};

}  // namespace railcast
