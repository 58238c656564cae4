#pragma once

#include <cstddef>
#include <cstdint>

#include "core/detect/base/echo_tiles.h"

namespace railcast {

/// An echo that no surface in the beam sends.
struct AddedEcho {
  std::uint32_t label{};
  std::uint32_t echo{};  ///< Its number within the firing.
  float range_m{};
  float power_ratio{};
  float intensity{};
  /// Half the range over which it is above the threshold (DetectTile::busy_m), if it comes after
  /// effect `saturation`.
  float busy_m = 0.0F;
};

/// Adds an echo with the outcome `clutter` to the firing in lane `beam`. The receiver's loops have
/// still to detect and measure it.
EchoTiles::Place AddEcho(std::size_t beam, const AddedEcho& added, EchoTiles& echoes);

/// Adds an echo that is detected and measured already: its point lies at its range.
void AddMeasuredEcho(std::size_t beam, const AddedEcho& added, EchoTiles& echoes);

}  // namespace railcast
