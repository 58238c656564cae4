#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "analysis/estimate/streams.h"
#include "core/points/nearest_points.h"
#include "railcast/io/recording.h"

namespace railcast {

/// The points of a frame, of all its returns, in the sensor frame; points that are not finite are
/// left out.
struct ComparedCloud {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<float> range_m;        ///< Distance from the sensor's origin; empty if unknown.
  std::vector<float> intensity;      ///< NaN where the intensity is not finite; empty if unknown.
  std::vector<std::uint16_t> rings;  ///< Empty if unknown.
  /// Along the beams; NaN where a point has none; empty if unknown.
  std::vector<float> velocity_mps;

  [[nodiscard]] std::size_t size() const { return points_m.size(); }
};

[[nodiscard]] inline ComparedCloud CloudOf(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  ComparedCloud cloud;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const float x = frame.x[slot], y = frame.y[slot], z = frame.z[slot];
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) continue;
    cloud.points_m.emplace_back(x, y, z);
    if (recorded.why_no_ranges.empty()) cloud.range_m.push_back(std::hypot(x, y, z));
    if (recorded.Has("intensity")) cloud.intensity.push_back(frame.intensity[slot]);
    if (recorded.Has("ring")) cloud.rings.push_back(frame.ring[slot]);
    if (recorded.Has("radial_velocity_mps")) {
      cloud.velocity_mps.push_back(frame.radial_velocity_mps[slot]);
    }
  }
  return cloud;
}

/// Counts by bin; only bins with a count are stored.
class Histogram {
 public:
  Histogram() = default;
  /// Each element adds one count to its bin.
  explicit Histogram(const std::vector<std::int64_t>& bins) : num_(bins.size()) {
    for (const std::int64_t bin : bins) ++counts_[bin];
  }
  static auto Sums(auto& of) { return std::tie(of.counts_, of.num_); }

  [[nodiscard]] std::uint64_t num() const { return num_; }
  [[nodiscard]] const std::map<std::int64_t, std::uint64_t>& counts() const { return counts_; }

 private:
  std::map<std::int64_t, std::uint64_t> counts_;
  std::uint64_t num_{};
};

/// Jensen-Shannon divergence of two histograms as distributions, in bits: 0 for equal ones, 1 for
/// disjoint ones (Lin 1991, IEEE Trans. Inf. Theory 37; base 2). NaN if either is empty.
[[nodiscard]] double JensenShannonDivergence(const Histogram& a, const Histogram& b);

/// The quantities that are compared as histograms.
struct CloudHistograms {
  Histogram range;  ///< Bins of 1 m.
  /// Bins of an eighth octave (9 % wide); everything up to 0.001 is in one bin.
  Histogram intensity;
  Histogram ring;      ///< One bin per ring.
  Histogram velocity;  ///< Bins of 1 m/s.
  /// Bird's-eye occupancy: a cell of 1 m x 1 m counts once per frame if it holds any point.
  Histogram occupancy;

  static auto Sums(auto& of) {
    return std::tie(of.range, of.intensity, of.ring, of.velocity, of.occupancy);
  }
};

[[nodiscard]] CloudHistograms HistogramsOf(const ComparedCloud& cloud);

inline constexpr double kIntensityBinsAnOctave = 8.0;

/// The middle of a bin of CloudHistograms::intensity.
[[nodiscard]] double IntensityOfBin(std::int64_t bin);

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

/// The overload for search trees that already exist.
/// @pre Both clouds have points.
[[nodiscard]] CloudDistances DistancesOf(const NearestPoints& a_in_b,
                                         const NearestPoints& b_in_a,
                                         const std::vector<double>& distances_m);

/// Number of points, intensities and velocities of a cloud in each of RangeBins()
/// (analysis/stats/bins.h).
struct BinnedCloud {
  struct Bin {
    std::uint64_t num_points{};
    std::uint64_t num_intensities{};
    double intensity_sum{};
    std::uint64_t num_velocities{};
    double velocity_sum_mps{};

    static auto Sums(auto& of) {
      return std::tie(of.num_points, of.num_intensities, of.intensity_sum, of.num_velocities,
                      of.velocity_sum_mps);
    }
    /// NaN where fewer than kMinSamples points have an intensity.
    [[nodiscard]] double MeanIntensity() const;
    /// NaN where fewer than kMinSamples points have a velocity.
    [[nodiscard]] double MeanVelocity_mps() const;
  };
  std::vector<Bin> bins;
};

[[nodiscard]] BinnedCloud BinnedByRange(const ComparedCloud& cloud);

/// Mean absolute percentage errors of B against A: the mean over bins of |B - A| / A, in percent
/// (Haider et al. 2022, Sensors 22(19) 7556, for a target at several distances). Velocities, which
/// may be 0, have the mean of |B - A| itself. Bins in which A has fewer than kMinSamples points
/// take no part; NaN if none does.
struct BinErrors {
  double points = std::numeric_limits<double>::quiet_NaN();
  double intensity = std::numeric_limits<double>::quiet_NaN();
  double velocity_mps = std::numeric_limits<double>::quiet_NaN();
};

[[nodiscard]] BinErrors ErrorsOf(const BinnedCloud& a, const BinnedCloud& b);

/// The divergences and errors, in the order of PairMetrics() (comparison.h).
[[nodiscard]] std::vector<double> DistributionFigures(const CloudHistograms& a,
                                                      const CloudHistograms& b,
                                                      const BinErrors& errors);

/// Sums over pairs of frames, bin by bin.
class BinSums {
 public:
  struct Bin {
    Moments points_a, points_b;              ///< Per frame.
    Moments intensity_a, intensity_b;        ///< Mean intensities of the frames.
    Moments points_change;                   ///< (B - A) / A, where A has enough points.
    Moments intensity_change;                ///< (B - A) / A of the mean intensity.
    Moments velocity_a_mps, velocity_b_mps;  ///< Mean velocities of the frames.
    Moments velocity_change_mps;             ///< B - A of the mean velocity.
  };

  BinSums();
  void Add(const BinnedCloud& a, const BinnedCloud& b);
  [[nodiscard]] const std::vector<Bin>& bins() const { return bins_; }
  /// The errors of the sums over all frames.
  [[nodiscard]] BinErrors Errors() const { return ErrorsOf(sum_a_, sum_b_); }

 private:
  std::vector<Bin> bins_;
  BinnedCloud sum_a_, sum_b_;
};

}  // namespace railcast
