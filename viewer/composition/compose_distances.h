#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "railcast/transform.h"
#include "viewer/composition/choices.h"
#include "viewer/composition/composition.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// Returns the transform from the second frame's sensor axes to the first's, each at its stamp, by
/// way of the world. Empty if a frame has no pose: both then stay in their own axes, taken as the
/// same, and only the different offsets subtracted from their positions are corrected.
[[nodiscard]] std::optional<Transform> FirstFromSecond(const ShownFrame& first,
                                                       const ShownFrame& second);

/// Returns for every point the distance in metres to the nearest point of the other frame, with the
/// frames registered by FirstFromSecond(). NaN if the other frame has no points. Runs in parallel;
/// the result does not depend on the number of threads.
[[nodiscard]] std::vector<float> DistancesToNearest_m(const ShownFrame& of,
                                                      const ShownFrame& other);

/// Shows two frames in the first one's axes, each point coloured by its distance to the nearest
/// point of the other frame. The frames are registered in world coordinates if both have poses.
[[nodiscard]] Composition ComposeDistances(const std::shared_ptr<const ShownFrame>& a,
                                           const std::shared_ptr<const ShownFrame>& b,
                                           const Choices& choices);

}  // namespace railcast
