#pragma once

#include "railcast/io/recording.h"
#include "viewer/overlays/beams.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

/// Range at which the segments of empty beams begin, away from the sensor, where all of them meet.
inline constexpr double kEmptyBeamStart_m = 2.0;
/// Range at which they end if it is not known what the beam hit.
inline constexpr double kEmptyBeamStub_m = 12.0;

/// Opacity of beams that hit something, and of beams that hit nothing, of which there are many.
inline constexpr float kLostBeamOpacity = 0.2F;
inline constexpr float kOpenBeamOpacity = 0.012F;

/// Draws the fan of a frame's firings without a return: one segment along each, in the order of
/// their slots, in the colour of its outcome (viewer/color/palette.h), or of `kUnknownOutcomeRgb`
/// where the recording has no outcomes. A segment goes from 2 m to the true range of what was hit
/// and not detected; where that is not known, or nothing was hit, it goes to 12 m: long enough to
/// show the fan, short enough to leave the scene clear. For hits nearer than 2 m (on the ego
/// vehicle, or below the minimum range of the sensor) the segment begins at the sensor.
///
/// Segments are turned from the sensor's axes at the firing into those at the stamp (ScanMotion),
/// as the points are. The overlay is empty if the frame's slots are not firings; firings of unknown
/// direction are left out.
/// @pre `beams` has the frame's rows and columns.
[[nodiscard]] Overlay DrawEmptyBeams(const RecordedFrame& recorded, const Beams& beams);

}  // namespace railcast
