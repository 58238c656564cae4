#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "analysis/compare/cloud.h"
#include "core/io/nearest_points.h"

namespace railcast {

/// Of the density-aware Chamfer distance, in 1/m: a point 0.1 m from the nearest counts 63 % as
/// missing, one 1 m from it wholly; the noise of sensors hardly counts.
inline constexpr double kDensityAwareAlpha_per_m = 10.0;

/// How well B shows A within a distance (Knapitsch et al. 2017, "Tanks and Temples", ACM TOG 36).
struct WithinDistance {
  double precision{};  ///< Share of B's points with one of A within it.
  double recall{};     ///< Share of A's points with one of B within it.
  double f_score{};    ///< Their harmonic mean; 0 if both are.
};

/// How far two clouds are apart. d(p, C) is the distance of a point from the nearest of a cloud.
struct CloudDistances {
  double a_to_b_m{};  ///< Mean of d(a, B).
  double b_to_a_m{};  ///< Mean of d(b, A).
  /// Chamfer distance: the mean of the two, as CD-P of Yuan et al. 2018 ("PCN", 3DV).
  double chamfer_m{};
  /// Its variant of squares: mean of d(a, B)^2 + mean of d(b, A)^2 (Fan et al. 2017, CVPR, as
  /// means).
  double chamfer_squares_m2{};
  double hausdorff_m{};  ///< The largest of all d(a, B) and d(b, A).
  /// The larger of the two 95th percentiles (Taha and Hanbury 2015, BMC Medical Imaging 15).
  double hausdorff95_m{};
  /// In [0, 1): the mean of 1 - exp(-alpha d) / n, n being how many points share the same nearest
  /// point; half of it from either side (Wu et al. 2021, NeurIPS, eq. 5).
  double density_aware{};
  std::vector<WithinDistance> within;  ///< By distance.
};

/// Nothing if either cloud has no points.
[[nodiscard]] std::optional<CloudDistances> DistancesOf(const ComparedCloud& a,
                                                        const ComparedCloud& b,
                                                        const std::vector<double>& distances_m);

/// The same with searches that are there already.
/// @pre Both clouds have points.
[[nodiscard]] CloudDistances DistancesOf(const NearestPoints& a_in_b,
                                         const NearestPoints& b_in_a,
                                         const std::vector<double>& distances_m);

}  // namespace railcast
