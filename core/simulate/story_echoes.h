#pragma once

#include <cstddef>
#include <vector>

#include "core/detect/base/echo_tiles.h"
#include "core/simulate/returns.h"
#include "railcast/ray_caster.h"
#include "railcast/simulator.h"

namespace railcast {

/// Adds the echoes of one firing to its story, with the slots of those that become returns.
/// @param beam A lane of `echoes.first`.
/// @pre story.slot is set.
void TellEchoes(const std::vector<Surface>& surfaces,
                const ReturnRule& rule,
                std::size_t beam,
                EchoTiles& echoes,
                FiringStory& story);

}  // namespace railcast
