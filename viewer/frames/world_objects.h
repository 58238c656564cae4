#pragma once

#include <vector>

#include "railcast/frame.h"
#include "railcast/io/recording.h"
#include "railcast/scene.h"

namespace railcast {

/// Returns the objects of a world at a frame's stamp, for frames that do not list them: names,
/// labels, boxes and velocities, means over the scan; their counts of firings are 0. The sensor's
/// own vehicle is left out.
/// @pre The frame's pose is known and in the world's coordinates.
[[nodiscard]] std::vector<RecordedObject> ObjectsAt(const World& world,
                                                    const LabelTable& labels,
                                                    const Frame& frame);

}  // namespace railcast
