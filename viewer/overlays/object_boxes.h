#pragma once

#include "core/frame/labels.h"
#include "core/io/recording/recording.h"
#include "viewer/overlays/drawing.h"

namespace railcast {

/// Centres of boxes farther than this from the sensor are left out.
inline constexpr double kMostBoxRange_m = 400.0;

/// The boxes of a frame's objects, in the order in which it lists them: twelve edges, a nose of two
/// more segments before the front face, so that the heading shows, and the name at the middle of
/// the top. In the colour of the object's label; white where `labels` does not have it.
[[nodiscard]] Drawing DrawObjectBoxes(const RecordedFrame& recorded, const LabelTable& labels);

}  // namespace railcast
