#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "analysis/compare/cloud.h"
#include "core/io/cloud/nearest_points.h"

namespace railcast {

/// Parameter of the density-aware Chamfer distance, in 1/m: a point 0.1 m from the nearest one
/// counts 63 % as missing and one 1 m away fully, so that sensor noise hardly counts.
inline constexpr double kDensityAwareAlpha_per_m = 10.0;

/// How well B reproduces A within a distance (Knapitsch et al. 2017, "Tanks and Temples", ACM TOG
/// 36).
struct WithinDistance {
  double precision{};  ///< Share of B's points that have a point of A within the distance.
  double recall{};     ///< Share of A's points that have a point of B within the distance.
  double f_score{};    ///< Harmonic mean of precision and recall; 0 if both are 0.
};

/// Distances between two clouds. d(p, C) is the distance from point p to the nearest point of C.
struct CloudDistances {
  double a_to_b_m{};  ///< Mean of d(a, B).
  double b_to_a_m{};  ///< Mean of d(b, A).
  /// Chamfer distance: the mean of a_to_b_m and b_to_a_m, as CD-P of Yuan et al. 2018 ("PCN", 3DV).
  double chamfer_m{};
  /// Chamfer distance of squares: mean of d(a, B)^2 + mean of d(b, A)^2 (Fan et al. 2017, CVPR,
  /// with means instead of sums).
  double chamfer_squares_m2{};
  double hausdorff_m{};  ///< Hausdorff distance: the largest of all d(a, B) and d(b, A).
  /// The larger of the 95th percentiles of d(a, B) and d(b, A) (Taha and Hanbury 2015, BMC Medical
  /// Imaging 15).
  double hausdorff95_m{};
  /// Density-aware Chamfer distance in [0, 1): the mean of 1 - exp(-alpha d) / n,
  /// where n is the number of points that share the same nearest point; each direction
  /// contributes half (Wu et al. 2021, NeurIPS, eq. 5).
  double density_aware{};
  std::vector<WithinDistance> within;  ///< One per distance asked for.
};

/// Returns nothing if either cloud has no points.
[[nodiscard]] std::optional<CloudDistances> DistancesOf(const ComparedCloud& a,
                                                        const ComparedCloud& b,
                                                        const std::vector<double>& distances_m);

/// As above, but with search trees that already exist.
/// @pre Both clouds have points.
[[nodiscard]] CloudDistances DistancesOf(const NearestPoints& a_in_b,
                                         const NearestPoints& b_in_a,
                                         const std::vector<double>& distances_m);

}  // namespace railcast
