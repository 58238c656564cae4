#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/io/recording/scan_table.h"
#include "core/io/recording/surface_point.h"
#include "railcast/io/recording.h"
#include "railcast/transform.h"

namespace railcast {

/// What PCL alone makes of the points in which a piece was found: the plane of RANSAC, fitted in
/// two passes to the points within 5 standard deviations, and normals, each from 12 points on it
/// (pcl::NormalEstimation). It computes in float32.
struct PclPlane {
  /// Standard deviation square to the plane, from the median of squares, which hardly depends on
  /// outliers; corrected for the plane's 3 degrees of freedom. NaN if PCL finds no plane.
  double sigma_m = std::numeric_limits<double>::quiet_NaN();
  std::size_t num_outliers{};
  double turn_rad{};     ///< Between its plane and ours.
  double normals_rad{};  ///< Root mean square of the angles between the normals and its plane's.
};

/// A small piece of surface that is flat within the noise.
struct PlanePatch {
  double range_m{};          ///< Mean range of its points.
  double incidence_rad{};    ///< Incidence at its middle.
  double step_m{};           ///< RangeStep_m() of its frame.
  double intensity{};        ///< Mean of the points that have one; NaN if none has.
  std::size_t num_points{};  ///< Without outliers.
  std::size_t num_outliers{};
  /// Sums of squared distances from the plane divided by num_points - 3 degrees of freedom: along
  /// the beams, and perpendicular to the plane.
  double range_squares_m2{};
  double plane_squares_m2{};
  PclPlane by_pcl;  ///< Only from FindPlanePatches(): it takes longer than all else.

  [[nodiscard]] double degrees() const { return static_cast<double>(num_points) - 3.0; }
};

/// A patch with its plane and its points.
struct FlatPiece {
  PlanePatch patch;
  Vector3 middle_m = Vector3::Zero();    ///< Mean of its points; lies in the plane.
  Vector3 normal = Vector3::UnitZ();     ///< Unit vector of either sign.
  std::vector<std::size_t> slots;        ///< Slots of its points, without outliers.
  std::vector<std::size_t> slots_about;  ///< Slots of all points among which it was found.
};

/// Maximum per frame, so that the time does not grow with the number of points.
inline constexpr std::size_t kMaxPatches = 150;

/// Finds planes in neighbourhoods of about 25 points, spread evenly over the frame (other places in
/// every frame): RANSAC (Fischler and Bolles 1981) to be safe from outliers and edges, then least
/// squares on the points within 5 robust standard deviations. Kept are those with at least 12
/// points, less than a fifth of them outliers, met under less than 60 deg, and with deviations of
/// less than 0.1 m + 0.5 mm a metre of range: more is no flat surface.
///
/// Neighbours are those of the grid; without one, the nearest in space.
/// @param scan Null if the frame is no grid.
[[nodiscard]] std::vector<FlatPiece> FindFlatPieces(const RecordedFrame& recorded,
                                                    const ScanTable* scan);
/// As FindFlatPieces(), without the pieces' slots, and with what PCL makes of each.
[[nodiscard]] std::vector<PlanePatch> FindPlanePatches(const RecordedFrame& recorded,
                                                       const ScanTable* scan);

}  // namespace railcast
