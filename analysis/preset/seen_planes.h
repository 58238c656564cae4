#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/io/recording/scan_table.h"
#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

/// A large plane in a recorded turn, in the sensor's axes.
struct SeenPlane {
  Vector3 middle_m = Vector3::Zero();  ///< Mean of its points; lies in the plane.
  Vector3 normal = Vector3::UnitZ();   ///< Unit vector of either sign.
  std::size_t num_points{};

  /// Range at which a ray from the sensor, or from a place in it, meets the plane; infinite or
  /// negative if it does not.
  [[nodiscard]] double RangeAlong_m(const Vector3& direction,
                                    const Vector3& origin_m = Vector3::Zero()) const {
    return normal.dot(middle_m - origin_m) / normal.dot(direction);
  }
  /// Whether it is level within 20 deg and below the sensor.
  [[nodiscard]] bool is_ground() const;
};

/// The planes of a recorded turn, and which of its firings must have met which of them.
struct SeenPlanes {
  /// SeenPlanes::plane of a firing that met no plane, or something else.
  static constexpr std::uint8_t kNone = 0xFF;

  ScanTable scan;
  std::vector<SeenPlane> planes;
  std::vector<std::uint8_t> plane;  ///< By row x scan.columns + column: index into `planes`.

  [[nodiscard]] std::uint8_t PlaneOf(std::size_t row, std::size_t column) const {
    return plane[row * scan.columns + column];
  }
};

/// A piece of a plane in which one kind of surface is met in one way: on level ground 5 deg of
/// azimuth and a bin of FineRangeBins(), on others 6 deg of elevation, a side of the foot of the
/// perpendicular, and 5 deg of incidence.
struct PlaneCell {
  std::size_t plane{};
  std::size_t strip{};
  std::size_t step{};  ///< Rises along the strip.

  auto operator<=>(const PlaneCell&) const = default;
};

/// The cell in which a ray from the sensor meets a plane.
/// @param direction Unit vector.
[[nodiscard]] PlaneCell CellOf(const SeenPlanes& seen, std::size_t plane, const Vector3& direction);

/// The firings of a turn that take part: all, or every second sector of 30 deg, so that what was
/// fitted to one half can be asked of the other.
enum class Sectors { kAll, kEven, kOdd };

/// Finds the planes of a turn, at most 24, each of at least 0.4 % of its points: the best of many
/// planes along the surface about a point (Fischler and Bolles 1981, with LocalNormal()), then
/// least squares. Only points about which the surface lies as the plane does, to 26 deg, count.
///
/// A point belongs to a plane if it lies within 4 cm + 1.5 mm a metre of it, within 10 % of the
/// range at which its ray meets the plane, and in a run of at least 8 such points of its ring,
/// about half of which or more the surface lies as the plane does. Firings without a point belong
/// to the plane of the points on either side if these are at most 5 firings away.
[[nodiscard]] SeenPlanes FindSeenPlanes(const Frame& frame,
                                        const ScanTable& scan,
                                        Sectors sectors = Sectors::kAll);

}  // namespace railcast
