#pragma once

#include <memory>

#include "viewer/scene/choices.h"
#include "viewer/scene/scene.h"

namespace railcast {

/// Two frames in the first one's axes, each coloured by the distance to the nearest point of the
/// other: in world coordinates if both have poses.
[[nodiscard]] Scene ComposeDistances(const std::shared_ptr<const ShownFrame>& a,
                                     const std::shared_ptr<const ShownFrame>& b,
                                     const Choices& choices);

}  // namespace railcast
