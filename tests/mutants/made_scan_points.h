#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "tests/mutants/mutants.h"

namespace railcast {

inline constexpr std::size_t kScanRings = 8;
inline constexpr std::size_t kScanColumns = 60;

/// A point of a scan between two walls: x, y, z in metres, intensity from 0 to 1, ring, and time in
/// seconds.
using ScanPoint = std::array<double, 6>;

/// A turn of eight beams in 0.1 s: column after column, every firing returns.
inline std::vector<ScanPoint> MakeScanPoints(double ahead_m = 0.0) {
  std::vector<ScanPoint> points;
  std::uint32_t state = 1;
  for (std::size_t column = 0; column < kScanColumns; ++column) {
    for (std::size_t ring = 0; ring < kScanRings; ++ring) {
      const double turn = static_cast<double>(column) / kScanColumns;
      const double azimuth_rad = 2.0 * std::numbers::pi * (turn + 0.003);
      const double elevation_rad =
          (-17.0 + 4.0 * static_cast<double>(ring)) * std::numbers::pi / 180.0;
      const double x = std::cos(azimuth_rad) * std::cos(elevation_rad);
      const double y = std::sin(azimuth_rad) * std::cos(elevation_rad);
      const double z = std::sin(elevation_rad);
      state = state * 1'664'525U + 1'013'904'223U;
      const double noise = static_cast<double>(state >> 16U) / 65536.0;
      const double to_wall_m = std::min((40.0 - ahead_m) / std::abs(x), 7.3 / std::abs(y));
      const double range_m = std::min(to_wall_m, z < 0.0 ? -2.1 / z : 60.0) + 0.02 * noise;
      points.push_back({range_m * x, range_m * y, range_m * z, 0.1 + 0.8 * noise,
                        static_cast<double>(ring), 0.0997 * turn});
    }
  }
  return points;
}

/// The numbers as a cloud of float32 with ring as uint16 and time as float64.
inline std::string BinaryRows(const std::vector<ScanPoint>& points) {
  std::string bytes;
  for (const ScanPoint& point : points) {
    for (std::size_t i = 0; i < 4; ++i) bytes += BytesOf(static_cast<float>(point.at(i)));
    bytes += BytesOf(static_cast<std::uint16_t>(point[4])) + BytesOf(point[5]);
  }
  return bytes;
}
inline constexpr std::size_t kRow_bytes = 26;
inline constexpr std::array<std::size_t, 6> kPlaces = {0, 4, 8, 12, 16, 18};
inline constexpr std::array<std::size_t, 6> kSizes = {4, 4, 4, 4, 2, 8};

}  // namespace railcast
