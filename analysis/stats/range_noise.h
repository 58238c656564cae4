#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "analysis/report/words.h"
#include "analysis/stats/plane_patches.h"
#include "analysis/stats/sums.h"
#include "core/io/recording/scan_table.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Range noise against range: from flat pieces of surface, and from the truth where frames have it.
///
/// From planes: the standard deviation of points about a fitted plane. Measured along the beams it
/// is the range noise if the sensor errs along its beams; measured perpendicular to the plane it is
/// the noise if positions err equally in all directions (as in the published model). Roughness of
/// the surface counts as noise, so the estimate is an upper bound on rough ground. Plain: the
/// squares of all patches pooled. Robust: the median over patches, which rough or curved patches
/// hardly affect, less what the ranges' step adds (WithoutRounding()).
class Noise {
 public:
  void Add(const RecordedFrame& recorded, const std::vector<PlanePatch>& patches);
  static auto Sums(auto& of) { return std::tie(of.planes_, of.truth_); }

  /// Planes in one bin of range.
  struct Planes {
    double degrees{};
    double range_squares_m2{};
    double plane_squares_m2{};
    std::uint64_t num_points{};
    std::uint64_t num_outliers{};
    /// Standard deviations of the patches, each corrected for its few degrees of freedom.
    LogHistogram range_sigmas_m;
    LogHistogram plane_sigmas_m;
    /// Spreads in the same patches by PCL's own estimators (PclPlane).
    LogHistogram pcl_sigmas_m, pcl_turns_rad, pcl_normals_rad;
    std::uint64_t num_pcl_outliers{};
    Moments step_m;  ///< RangeStep_m() of the frames that have one.

    static auto Sums(auto& of) {
      return std::tie(of.degrees, of.range_squares_m2, of.plane_squares_m2, of.num_points,
                      of.num_outliers, of.range_sigmas_m, of.plane_sigmas_m, of.pcl_sigmas_m,
                      of.pcl_turns_rad, of.pcl_normals_rad, of.num_pcl_outliers, of.step_m);
    }
    /// Pooled over the patches; not enough below kMinSamples patches.
    [[nodiscard]] Estimate RangeSigma_m() const;
    [[nodiscard]] Estimate PlaneSigma_m() const;
    [[nodiscard]] Estimate RobustRangeSigma_m() const;
    [[nodiscard]] Estimate RobustPlaneSigma_m() const;
  };

  /// By bin of RangeBins().
  [[nodiscard]] const std::vector<Planes>& planes() const { return planes_; }
  /// Measured minus true range of the points on surfaces, in m; empty without the truth.
  [[nodiscard]] const std::vector<Scatter>& truth() const { return truth_; }
  [[nodiscard]] Section MakeSection() const;

 private:
  std::vector<Planes> planes_;
  std::vector<Scatter> truth_;
};

/// The step of ranges in mm, as `step_mm` of words; empty without one.
[[nodiscard]] WordValue StepValue(const Moments& step_m);

/// Whether the sensor was elsewhere, or looked elsewhere, in the later frame.
/// @pre Both have a pose.
[[nodiscard]] bool HasMoved(const RecordedFrame& earlier, const RecordedFrame& later);

/// Range noise from what changes between two frames of a sensor that stands.
///
/// Firings of the same ring with azimuths less than half a column apart are paired, and the range
/// is corrected for the slope between them; only places that are flat enough for that (neighbours
/// within 0.3 m of a straight line) take part. sigma = standard deviation of the differences /
/// sqrt(2). Pairs of frames do not overlap, so that their samples are independent. What moves in
/// the scene spoils the plain figure and not the robust one. Where ranges come in steps, the robust
/// one is that before rounding (core/base/rounded_scale.h), and the plain one has the steps in it.
class TemporalNoise {
 public:
  /// Adds two consecutive frames.
  /// @param scan Of `later` (of both, where the pattern is fixed); null if it is not a grid.
  void Add(const RecordedFrame& earlier,
           const RecordedFrame& later,
           const ScanTable* earlier_scan,
           const ScanTable* later_scan);
  static auto Sums(auto& of) {
    return std::tie(of.num_pairs_, of.num_moved_, of.num_without_pose_, of.bins_);
  }

  /// Differences in one bin of range.
  struct Bin {
    Scatter differences_m;
    Moments step_m;  ///< Steps of the ranges, by the changes of the pairs that show it.

    static auto Sums(auto& of) { return std::tie(of.differences_m, of.step_m); }
    [[nodiscard]] Estimate Sigma_m() const;
    [[nodiscard]] Estimate RobustSigma_m() const;
  };

  [[nodiscard]] std::uint64_t num_pairs() const { return num_pairs_; }
  [[nodiscard]] std::uint64_t num_moved() const { return num_moved_; }
  /// By bin of RangeBins(); empty without pairs.
  [[nodiscard]] const std::vector<Bin>& bins() const { return bins_; }
  [[nodiscard]] Section MakeSection() const;

 private:
  std::uint64_t num_pairs_{};  ///< Pairs of frames that took part.
  std::uint64_t num_moved_{};  ///< Pairs of frames between which the sensor moved.
  /// Pairs without a pose among num_pairs_, for which the sensor is assumed to stand still.
  std::uint64_t num_without_pose_{};
  std::vector<Bin> bins_;
};

}  // namespace railcast
