#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan/scan_spec.h"

namespace railcast {

/// Embree traces 16 rays at once.
inline constexpr std::size_t kPacketSize = 16;

/// The fixed firings of one frame: a sensor is a table of directions and times.
///
/// Immutable after construction, so one pattern may serve many threads. All per-firing arrays have
/// num_firings() elements in order of time (ties: by row, then by column).
struct ScanPattern {
  double rate_hz{};
  std::uint32_t rows{};
  std::uint32_t columns{};

  std::vector<float> direction_x, direction_y, direction_z;  ///< Unit, sensor frame.
  std::vector<std::uint32_t> time_ns;                        ///< Since the stamp.
  std::vector<std::uint16_t> row;                            ///< Ring: 0 is the lowest channel.
  std::vector<std::uint32_t> column;

  /// Which firings share a packet: num_firings() rounded up to kPacketSize firing indices, the
  /// last packet filled up with its last firing. Neighbours in angle, so that packets are coherent;
  /// fixed, because what a ray on a vertex or edge hits depends on its packet.
  std::vector<std::uint32_t> packet_order;

  [[nodiscard]] std::size_t num_firings() const { return time_ns.size(); }
  /// Simulation time of a frame's first firing: frames are exactly 1 / rate_hz apart.
  /// @pre frame_index <= LastFrame().
  [[nodiscard]] std::int64_t StampNs(std::uint32_t frame_index) const;
  /// The last frame whose times fit into 64 bits, 292 years of nanoseconds.
  [[nodiscard]] std::uint32_t LastFrame() const;
};

/// The firing that fills a slot of a frame of this pattern.
/// @param returns Slots of a firing.
/// @pre returns > 0 and slot < rows * columns * returns: a slot of such a frame.
[[nodiscard]] std::uint32_t FiringOfSlot(const ScanPattern& pattern,
                                         std::uint32_t returns,
                                         std::size_t slot);

/// @throws InputError if the spec makes no firing or more than 2^24, a cell count is not whole, a
///   frame lasts longer than 1 / rate_hz or 4.29 s (time_ns is 32 bits), or the firing table cannot
///   be read. A line for every fault, with pointers relative to the scan object:
///   "/pattern/cycle_us: must be > 0 (got -1)"; those of a table name its file and line.
[[nodiscard]] ScanPattern BuildScanPattern(const ScanSpec& spec);

}  // namespace railcast
