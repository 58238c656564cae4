#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.h"
#include "railcast/lidar.h"

namespace railcast {

/// The firing cycles of a frame, in each of which every channel fires once.
struct FiringCycles {
  const std::vector<ChannelSpec>& channels;
  double cycle_us{};
  std::uint32_t columns{};
};

/// Appends the faults of cycles that do not fit into a frame, with pointers relative to the scan.
void CheckCycles(const FiringCycles& cycles, double rate_hz, ErrorList& errors);

/// The row of each channel: its rank by elevation, starting with the lowest. Channels of equal
/// elevation keep their order.
[[nodiscard]] std::vector<std::uint16_t> RowsByElevation(const std::vector<ChannelSpec>& channels);

/// The numbers of the firing cycles of a turn that fire: those that begin in the azimuth window.
/// They are the columns of a frame.
[[nodiscard]] std::vector<std::uint32_t> FiredCycles(const SpinningSpec& spec, double rate_hz);

/// Fills the origins of the beams, which turn with the rotor.
/// @pre The pattern's firings are those of the spec, which has a beam_origin_m.
void AddBeamOrigins(const SpinningSpec& spec, ScanPattern& pattern);

}  // namespace railcast
