#pragma once

#include "core/io/recording/recording.h"
#include "viewer/overlays/beams.h"
#include "viewer/overlays/drawing.h"

namespace railcast {

/// Where the segments of empty beams begin, clear of the sensor where all meet.
inline constexpr double kEmptyBeamStart_m = 2.0;
/// Where they end if nothing is known that the beam hit.
inline constexpr double kEmptyBeamStub_m = 12.0;

/// How faint they are: those that hit something, and those into the open, of which there are many.
inline constexpr float kLostBeamOpacity = 0.2F;
inline constexpr float kOpenBeamOpacity = 0.012F;

/// The fan of a frame's firings that brought nothing back: a segment along each, by its slot, in
/// the colour of its outcome (viewer/color/outcome_colors.h), of `kUnknownOutcomeRgb` where the
/// recording has no outcomes. From 2 m to the true range of what was hit and not detected; where
/// that is not known, or nothing was hit, to 12 m: long enough for a fan, short enough to leave the
/// scene clear. What was hit nearer than 2 m (the vehicle itself, what is nearer than the sensor
/// measures) has its segment from the sensor on.
///
/// Turned from the sensor's axes at the firing into those at the stamp (ScanMotion), as the points
/// are. Empty if the frame's slots are no firings; firings of unknown direction are left out.
/// @pre `beams` has the frame's rows and columns.
[[nodiscard]] Drawing DrawEmptyBeams(const RecordedFrame& recorded, const Beams& beams);

}  // namespace railcast
