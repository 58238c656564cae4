#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/rail/line/track_course.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/alignment.h"
#include "railcast/transform.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Supports stand at multiples of this part of the longest span.
inline constexpr std::size_t kStepsOfASpan = 26;

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

/// Stagger towards the outside of a curve; nothing where the line is straight enough for staggers
/// to alternate.
[[nodiscard]] std::optional<double> StaggerInCurve(const CatenarySpec& spec,
                                                   double curvature_per_m);

/// Lateral displacement of a pantograph's middle by cant, at the height of the contact line, left
/// positive.
[[nodiscard]] double PantographShift_m(const CatenarySpec& spec, const AxisPoint& axis);

/// A track's axis at a support: left of the alignment, and above it.
struct AxisOffset {
  double d_m{};
  double lift_m = 0.0;
};

/// The level frame of one track at one support, in which cantilever and wires are described: x
/// along the heading, z up. The origin lies below the middle of a pantograph by the height of the
/// contact line, at PantographShift_m() from the track's axis.
[[nodiscard]] Transform WorldFromSupport(const Alignment& alignment,
                                         const WorldSpec& spec,
                                         const AxisOffset& axis,
                                         double s_m);

}  // namespace railcast
