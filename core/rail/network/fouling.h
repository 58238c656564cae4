#pragma once

#include <optional>

#include "core/rail/line/track_course.h"

namespace railcast {

struct TurnoutSite;

/// Distance of the axes of two tracks that join at their fouling point, where the marker stands
/// (in German the Grenzzeichen).
inline constexpr double kFoulingDistance_m = 3.5;

/// The chainage at which the branch of a turnout is `distance_m` away from the track in which the
/// turnout lies, measured across the alignment; absent if it never is.
[[nodiscard]] std::optional<double> ClearChainage_m(const TrackCourse& track,
                                                    const TrackCourse& branch,
                                                    const TurnoutSite& turnout,
                                                    double distance_m);

}  // namespace railcast
