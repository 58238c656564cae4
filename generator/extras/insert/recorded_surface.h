#pragma once

#include <cstddef>

#include "generator/extras/insert/recorded_firings.h"
#include "railcast/effects.h"

namespace railcast {

/// The share of its beam that a recorded return took: less than 1 at the edge of a surface, where
/// it is weaker than the returns beside it on the same surface, since part of the beam passes by.
/// @param firing Index in the pattern; `slot` is one of its slots.
[[nodiscard]] float BeamShareAt(const RecordedFirings& firings,
                                std::size_t firing,
                                std::size_t slot);

/// How much of its peak the pulse of a recorded return kept on a surface that slants through the
/// beam (docs/physics.md 3.4), whose normal is that of the plane through the returns beside it: of
/// several such planes, the one that faces the sensor most. 1 where there are none.
[[nodiscard]] float PeakKeptAt(const RecordedFirings& firings,
                               const BeamSpec& beam,
                               std::size_t firing,
                               std::size_t slot);

}  // namespace railcast
