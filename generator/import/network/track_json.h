#pragma once

#include "generator/import/lines/line_world.h"
#include "railcast/rail_world.h"

namespace railcast {

/// A track as scenario files have it.
[[nodiscard]] WorldJson JsonOf(const TrackSpec& track);

}  // namespace railcast
