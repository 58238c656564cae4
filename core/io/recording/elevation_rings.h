#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace railcast {

inline constexpr std::size_t kMaxRings = 256;

/// Returns the ring of each point by its elevation, 0 the lowest. Nothing is returned unless the
/// elevations lie in 2 to kMaxRings clusters that hold 98 % of the points and of which none is
/// wider than half its distance to the next. The remaining points belong to the nearest cluster.
[[nodiscard]] std::optional<std::vector<std::uint32_t>> RingsByElevation(
    std::span<const double> elevations_rad);

/// A point as seen along the axis of a spinning sensor.
struct LevelPoint {
  double from_axis_m{};
  double up_m{};

  /// From a beam's origin: outwards of the axis and up (SpinningSpec::beam_origin_m).
  [[nodiscard]] double ElevationFrom_rad(const std::array<double, 2>& origin_m) const;
};

/// Rings of points and the origin of the beams from which they are level.
struct FoundRings {
  std::vector<std::uint32_t> rings;  ///< Ring of each point, 0 the lowest.
  std::array<double, 2> origin_m{};  ///< Outwards and up.
};

/// Finds rings as RingsByElevation() does, seen from the sensor's origin or, where there are none,
/// from the place within 0.1 m beside and 0.3 m above or below it from which the elevations are
/// crowded the most, if two fifths of the points or more are within 100 m.
[[nodiscard]] std::optional<FoundRings> FindRings(std::span<const LevelPoint> points);

/// Returns the origin from which the points of each ring have the most alike elevations, by least
/// squares; each part is 0 if it is within a millimetre, or less than five standard deviations
/// away.
/// @pre There is a point.
[[nodiscard]] std::array<double, 2> OriginOfRings(std::span<const LevelPoint> points,
                                                  std::span<const std::uint32_t> rings);

}  // namespace railcast
