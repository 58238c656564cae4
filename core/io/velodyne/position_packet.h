#pragma once

#include <cstdint>
#include <string>

#include "core/io/datagrams.h"

namespace railcast {

/// Simulation time 0 in seconds since 1970: 2000-01-01 00:00:00 UTC.
inline constexpr std::int64_t kSimulationEpoch_s = 946'684'800;

/// What Velodyne's clocks say at a simulation time: microseconds past the hour.
[[nodiscard]] std::uint32_t MicrosecondsPastHour(std::int64_t time_ns);

/// The NMEA sentence of the second that `time_ns` lies in, with its checksum and line end: time and
/// date. The simulated world has no place on Earth: 0 N 0 E, marked as no fix ("V"). Left empty,
/// velodyne_decoder for one would not read the time either.
[[nodiscard]] std::string GprmcSentence(std::int64_t time_ns);

/// Appends the 512 bytes that a sensor sends from port 8308: its clock (byte 0xC6), a locked pulse
/// per second (0xCA) and the sentence (0xCE).
void AppendPositionPacket(std::int64_t time_ns, Datagrams& datagrams);

}  // namespace railcast
