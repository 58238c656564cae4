#pragma once

#include <array>
#include <cstdint>

#include "core/base/units.h"
#include "railcast/enum_names.h"
#include "railcast/scenario.h"

namespace railcast {

/// The time that stamps of live frames state.
enum class StampClock {
  kSimulated,  ///< Simulation time.
  kUtc,        ///< The time of day.
  kTai,        ///< The same in atomic time, which grandmasters of PTP tell.
};
template <>
inline constexpr auto kEnumNames<StampClock> = std::to_array<EnumName<StampClock>>(
    {{StampClock::kSimulated, "simulated"}, {StampClock::kUtc, "utc"}, {StampClock::kTai, "tai"}});

/// By how much TAI is ahead of UTC since the last leap second, that of 2016 (IERS, Bulletin C 52).
inline constexpr std::int64_t kTaiAhead_ns = 37 * kNsPerS;

/// Whether the sensors whose packets a protocol has follow PTP (IEEE 1588): Hesai's state what the
/// grandmaster tells, as their manuals say, and Ouster's do with TIME_FROM_PTP_1588. Velodyne's are
/// sent as they are by GPS, and nodes of ROS 2 follow the clock of their machine.
[[nodiscard]] constexpr bool FollowsPtp(Protocol protocol) {
  return protocol >= Protocol::kPandar64 && protocol <= Protocol::kOuster;
}

}  // namespace railcast
