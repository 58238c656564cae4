#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/lidar.h"

namespace railcast {

/// The most by which elevations and azimuths of a scan may differ from the model's: the resolution
/// of a packet's azimuth.
inline constexpr double kMaxChannelOffset_deg = 0.01;
/// The most by which firing times and cycles may differ; at 20 Hz the rotor turns by 0.00007 deg in
/// that time.
inline constexpr double kMaxTimeOffset_us = 0.01;

/// What the packets of a spinning sensor take for granted.
struct PacketScan {
  std::string_view name;  ///< Name of the sensor.
  const std::vector<ChannelSpec>& channels;
  double cycle_us{};
  bool has_own_angles{};             ///< Whether each unit has angles and times of its own.
  std::size_t cycles_per_block = 1;  ///< A frame has whole blocks.
};

/// Reports what in a sensor does not fit the packets of a protocol.
class ScanFit {
 public:
  explicit ScanFit(std::string_view protocol);

  /// Checks that the scan is one that the packets' sensor could make: it turns clockwise, has that
  /// sensor's channels in the vendor's order and its firing cycle, and a whole turn of cycles,
  /// since packets continue into the next frame and have a single time stamp.
  /// @throws InputError with the first rule that is broken:
  ///   "--protocol vlp16: /lidar/scan/pattern/rotation: must be ...".
  void CheckPattern(const ScanSpec& scan, const PacketScan& expected) const;

  /// @param place Relative to the sensor: "/scan/pattern/rotation".
  /// @throws InputError in any case.
  [[noreturn]] void Fail(const std::string& place,
                         const std::string& rule,
                         const std::string& got = {}) const;

 private:
  void CheckNear(const std::string& place,
                 double got,
                 double expected,
                 double tolerance,
                 const std::string& name) const;
  void CheckChannels(const std::vector<ChannelSpec>& channels, const PacketScan& expected) const;
  void CheckColumns(const SpinningSpec& pattern,
                    double rate_hz,
                    std::size_t cycles_per_block) const;

  std::string prefix_;
};

/// What ColumnsOfCycles() has for a cycle that does not fire.
inline constexpr std::uint32_t kNotFired = 0xFFFFFFFF;

/// The column of a frame that holds each firing cycle of a turn, or kNotFired outside of the
/// azimuth window.
[[nodiscard]] std::vector<std::uint32_t> ColumnsOfCycles(const SpinningSpec& pattern,
                                                         double rate_hz);

/// The unit of the packets' azimuths.
inline constexpr double kAzimuthUnit_deg = 0.01;
inline constexpr std::int64_t kAzimuthUnitsPerTurn = 36'000;

/// From one azimuth in these units to the next, past 0, too.
[[nodiscard]] inline std::int64_t StepTo(std::int64_t azimuth, std::int64_t before) {
  const std::int64_t step = azimuth - before;
  return step < 0 ? step + kAzimuthUnitsPerTurn : step;
}

/// Returns the azimuth of the rotor in the packets' unit of 0.01 deg, 0 to 35999.
/// @param turns How far it has turned since it was at start_azimuth_deg.
[[nodiscard]] std::uint16_t RotorAzimuth(double start_azimuth_deg, double turns);

}  // namespace railcast
