#pragma once

#include <vector>

#include "core/frame/labels.h"
#include "core/io/recording/recording.h"
#include "core/scene/world.h"

namespace railcast {

/// The objects of a world at a frame's stamp, for frames that do not bring them: names, labels and
/// boxes; what firings saw of them is 0. Never the sensor's own vehicle.
/// @pre The frame's pose is known and in the world's coordinates.
[[nodiscard]] std::vector<RecordedObject> ObjectsAt(const World& world,
                                                    const LabelTable& labels,
                                                    const Frame& frame);

}  // namespace railcast
