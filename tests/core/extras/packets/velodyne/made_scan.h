#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/extras/packets/spinning/spinning_encoder.h"
#include "core/scan/spinning_pattern.h"
#include "railcast/lidar.h"

namespace railcast {

// A Velodyne data packet, as its manual has it (VLP-16 user manual 63-9243, chapter 9).
inline constexpr std::size_t kVelodynePacketSize = 1206;
inline constexpr std::size_t kBlocksPerPacket = 12;
inline constexpr std::size_t kBlockSize = 100;
inline constexpr std::size_t kAzimuthPlace = 2;  ///< In a block.
inline constexpr std::size_t kReturnsPlace = 4;  ///< In a block.
inline constexpr std::size_t kReturnSize = 3;
inline constexpr std::size_t kTimePlace = 1200;
inline constexpr std::size_t kModePlace = 1204;
inline constexpr std::size_t kModelPlace = 1205;

/// Returns the name of the sensor's file for a format.
[[nodiscard]] inline std::string_view SensorOf(std::string_view format) {
  return format == "vlp16-dual" ? "vlp16" : format;
}
[[nodiscard]] inline ReturnMode ReturnModeOfFormat(std::string_view format) {
  return format == "vlp16-dual" ? ReturnMode::kDual : ReturnMode::kStrongest;
}

/// Frames of a scan, with a tenth of their slots empty, ranges from 0.5 to 140 m and intensities of
/// every kind: random, but the same each time. Points lie in the firings' exact directions.
class MadeScan {
 public:
  explicit MadeScan(ScanSpec spec)
      : spec_(std::move(spec)),
        spinning_(std::holds_alternative<SpinningSpec>(spec_.pattern)
                      ? std::get<SpinningSpec>(spec_.pattern)
                      : SpinningSpec()),
        pattern_(BuildScanPattern(spec_)),
        rows_(RowsByElevation(spinning_.channels)) {}

  [[nodiscard]] const ScanSpec& spec() const { return spec_; }
  [[nodiscard]] const SpinningSpec& spinning() const { return spinning_; }
  [[nodiscard]] std::uint16_t RowOf(std::size_t laser) const { return rows_[laser]; }
  [[nodiscard]] std::size_t num_lasers() const { return rows_.size(); }

  /// Returns the azimuth that a block beginning with this column must have.
  [[nodiscard]] std::int64_t AzimuthUnits(std::uint32_t column) const {
    const double turned_deg = 360.0 * spec_.rate_hz * column * spinning_.cycle_us * 1e-6;
    return std::llround(100.0 * (spinning_.start_azimuth_deg + turned_deg)) % 36'000;
  }

  [[nodiscard]] Frame MakeFrame(std::uint32_t index, std::uint32_t returns = 1) const {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    Frame frame;
    const ScanPattern pattern = PatternOfFrame(pattern_, index);
    frame.Resize(pattern.rows, pattern.columns, returns);
    frame.index = index;
    frame.stamp_ns = pattern.StampNs(index);
    frame.duration_ns = pattern.time_ns.back();
    for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
      const std::size_t first =
          pattern.row[i] * std::size_t{frame.width()} + std::size_t{pattern.column[i]} * returns;
      for (std::size_t slot = first; slot < first + returns; ++slot) {
        const auto words =
            RandomWords(7, RandomUse::kNoise, index, static_cast<std::uint32_t>(slot));
        const bool has_point = UnitFloat(words[0]) > 0.1F;
        const float range_m = has_point ? 0.5F + 139.5F * UnitFloat(words[1]) : kNaN;
        frame.range_m[slot] = range_m;
        frame.x[slot] = range_m * pattern.direction_x[i];
        frame.y[slot] = range_m * pattern.direction_y[i];
        frame.z[slot] = range_m * pattern.direction_z[i];
        if (!pattern.origin_x_m.empty()) {
          frame.x[slot] += pattern.origin_x_m[i];
          frame.y[slot] += pattern.origin_y_m[i];
          frame.z[slot] += pattern.origin_z_m[i];
        }
        frame.intensity[slot] = UnitFloat(words[2]) * (words[3] % 8 == 0 ? 2000.0F : 1.0F);
        frame.time_ns[slot] = pattern.time_ns[i];
        frame.ring[slot] = pattern.row[i];
        frame.column[slot] = pattern.column[i];
        frame.outcome[slot] = has_point ? Outcome::kReturned : Outcome::kNoSurface;
      }
    }
    return frame;
  }

  /// @returns The azimuth, clockwise from 0 to 360 deg.
  [[nodiscard]] static double AzimuthOf(const Frame& frame, std::size_t slot) {
    const double azimuth_deg = DegFromRad(
        std::atan2(-static_cast<double>(frame.y[slot]), static_cast<double>(frame.x[slot])));
    return azimuth_deg < 0.0 ? azimuth_deg + 360.0 : azimuth_deg;
  }

 private:
  ScanSpec spec_;
  SpinningSpec spinning_;
  ScanPattern pattern_;
  std::vector<std::uint16_t> rows_;
};

/// Returns the datagrams of frames 0 to n - 1.
[[nodiscard]] inline Datagrams EncodeAll(std::string_view format,
                                         const MadeScan& scan,
                                         const std::vector<Frame>& frames) {
  const auto encoder =
      MakeSpinningEncoder(*FindSpinningModel(format), scan.spec(), ReturnModeOfFormat(format));
  Datagrams datagrams;
  for (const Frame& frame : frames) encoder->Encode(frame, datagrams);
  return datagrams;
}

/// Returns the payloads for the data port.
[[nodiscard]] inline std::vector<std::span<const char>> DataPackets(const Datagrams& datagrams) {
  std::vector<std::span<const char>> packets;
  for (const Datagrams::Item& item : datagrams.items) {
    if (item.port == DatagramPort::kData) packets.push_back(datagrams.BytesOf(item));
  }
  return packets;
}

}  // namespace railcast
