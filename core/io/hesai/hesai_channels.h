#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "railcast/lidar.h"

namespace railcast {

// The channels of Hesai's sensors with the maker's angles and times, as scenarios/sensors has them.
// Azimuths count clockwise, times from the start of the firing cycle.

/// The 64 channels of Pandar64 in the vendor's order.
[[nodiscard]] std::vector<ChannelSpec> Pandar64Channels();

/// The 32 channels of XT32 in the vendor's order, from the highest down.
[[nodiscard]] std::vector<ChannelSpec> Xt32Channels();

inline constexpr std::size_t kQt128Lasers = 128;
inline constexpr std::size_t kQt128Loops = 2;

/// The lasers that QT128 fires in each of its two loops, from 0 in rising order: 32 to 127, then 0
/// to 31 and 64 to 127.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> Qt128Loops();

/// The 192 firings of a cycle of QT128, which takes both loops: those of loop 1, then those of loop
/// 2, as Qt128Loops() lists them. Half of the lasers fire twice.
[[nodiscard]] std::vector<ChannelSpec> Qt128Channels();

}  // namespace railcast
