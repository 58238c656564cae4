#pragma once

#include <optional>
#include <vector>

#include "core/base/transform.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// How two frames are laid over each other: the second's sensor axes at its stamp in those of the
/// first, by way of the world. Nothing if one of them has no pose: then both stay in their own axes
/// as if those were the same; only what was subtracted from their positions is put right.
[[nodiscard]] std::optional<Transform> FirstFromSecond(const ShownFrame& first,
                                                       const ShownFrame& second);

/// Of every point the distance to the nearest point of the other frame, both laid over each other
/// as FirstFromSecond() says, in metres. NaN if the other has no points. In parallel; the same at
/// any number of threads.
[[nodiscard]] std::vector<float> DistancesToNearest_m(const ShownFrame& of,
                                                      const ShownFrame& other);

}  // namespace railcast
