#pragma once

#include <memory>

#include "viewer/composition/choices.h"
#include "viewer/composition/composition.h"

namespace railcast {

/// Shows two frames in the first one's axes, each point coloured by its distance to the nearest
/// point of the other frame. The frames are registered in world coordinates if both have poses.
[[nodiscard]] Composition ComposeDistances(const std::shared_ptr<const ShownFrame>& a,
                                           const std::shared_ptr<const ShownFrame>& b,
                                           const Choices& choices);

}  // namespace railcast
