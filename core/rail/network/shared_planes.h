#pragma once

#include "core/rail/line/track_course.h"

namespace railcast {

/// The course of a track that begins or ends in turnouts, with its height: over a turnout, until
/// the tracks have sleepers of their own, it lies in the canted plane of the track in which the
/// turnout lies. From there it returns to the height of the alignment within 60 m, or, where two
/// turnouts leave no room for that, passes from one plane to the other. Where even the turnouts'
/// bearers touch, it begins to do so behind the frogs.
/// @param begin The track in which it begins; null if it begins in none.
/// @param end As above, where it ends.
[[nodiscard]] TrackCourse InPlanesOfTurnouts(const TrackCourse& course,
                                             const TrackCourse* begin,
                                             const TrackCourse* end);

}  // namespace railcast
