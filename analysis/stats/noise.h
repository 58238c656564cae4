#pragma once

#include <cstdint>
#include <vector>

#include "analysis/estimate/streams.h"
#include "analysis/report/report.h"
#include "analysis/stats/plane_patches.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Range noise against range: from flat pieces of surface, and from the truth where frames have it.
///
/// From planes: the standard deviation of points about a fitted plane. Measured along the beams it
/// is the range noise if the sensor errs along its beams; measured perpendicular to the plane it is
/// the noise if positions err equally in all directions (as in the published model). Roughness of
/// the surface counts as noise, so the estimate is an upper bound on rough ground. Plain: the
/// squares of all patches pooled. Robust: the median over patches, which rough or curved patches
/// hardly affect.
class Noise {
 public:
  void Add(const RecordedFrame& recorded, const std::vector<PlanePatch>& patches);
  void Add(const Noise& other);

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
    /// Of the same patches by PCL's own estimators (PclPlane).
    LogHistogram pcl_sigmas_m, pcl_turns_rad, pcl_normals_rad;
    std::uint64_t num_pcl_outliers{};

    void Add(const Planes& other);
    /// Pooled over the patches; not enough below kMinSamples patches.
    [[nodiscard]] Estimate RangeSigma_m() const;
    [[nodiscard]] Estimate PlaneSigma_m() const;
    [[nodiscard]] Estimate RobustRangeSigma_m() const { return range_sigmas_m.Median(); }
    [[nodiscard]] Estimate RobustPlaneSigma_m() const { return plane_sigmas_m.Median(); }
  };
  /// Measured minus true range of the points on surfaces, in one bin of range.
  struct Truth {
    Moments errors_m;
    LogHistogram robust_errors_m;

    void Add(const Truth& other);
  };

  /// By bin of RangeBins().
  [[nodiscard]] const std::vector<Planes>& planes() const { return planes_; }
  /// Empty without the truth.
  [[nodiscard]] const std::vector<Truth>& truth() const { return truth_; }
  [[nodiscard]] Section MakeSection() const;

 private:
  std::vector<Planes> planes_;
  std::vector<Truth> truth_;
};

}  // namespace railcast
