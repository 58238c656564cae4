#pragma once

#include <cstdint>
#include <string>

#include "core/io/datagrams.h"

namespace railcast {

/// Simulation time 0 in seconds since 1970: 2000-01-01 00:00:00 UTC.
inline constexpr std::int64_t kSimulationEpoch_s = 946'684'800;

/// Returns the value of Velodyne's clocks at a simulation time: microseconds past the hour.
[[nodiscard]] std::uint32_t MicrosecondsPastHour(std::int64_t time_ns);

/// Returns the NMEA sentence, with checksum and line end, for the second in which `time_ns` lies.
/// It gives time and date. The simulated world has no place on Earth, so the position is 0 N 0 E,
/// marked as no fix ("V"). If the position were left empty, decoders such as velodyne_decoder would
/// not read the time either.
[[nodiscard]] std::string GprmcSentence(std::int64_t time_ns);

/// Appends the 512 bytes that a sensor sends from port 8308: its clock (byte 0xC6), the state
/// "locked" of the pulse per second (0xCA) and the sentence (0xCE).
void AppendPositionPacket(std::int64_t time_ns, Datagrams& datagrams);

}  // namespace railcast
