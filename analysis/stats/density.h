#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "analysis/estimate/power_law.h"
#include "analysis/report/report.h"
#include "analysis/stats/names.h"
#include "core/io/recording/scan_table.h"
#include "railcast/io/recording.h"

namespace railcast {

/// How densely points lie on surfaces, against range.
///
/// A firing of solid angle W that meets a surface at range R under incidence i stands for W R^2 /
/// cos(i) of it. Density = points / area of the firings' surfaces, in bins of range. With the truth
/// in the frames every firing counts that met the surface, with a point or not, by label; without
/// it, every firing with points above, below, left and right of it on one surface, whose area is
/// half of that between them, and with a point on the same surface or none, by how the surface
/// stands: level (normal within 20 deg of up), upright (beyond 70 deg) or slanted.
///
/// With a uniform raster and no losses the slope is -3 on level ground (the incidence grows with
/// range) and -2 on faces met under the same incidence everywhere (docs/physics.md 1.5).
class Density {
 public:
  /// Frames without a grid are skipped.
  /// @param scan Of the frame; null if it has none.
  void Add(const RecordedFrame& recorded, const ScanTable* scan);
  void Add(const Density& other);

  /// Counts in one bin of range on one kind of surface.
  struct Count {
    std::uint64_t num_firings{};  ///< Firings that met the surface ...
    std::uint64_t num_points{};   ///< ... and their points.
    double area_m2{};
    double solid_angle_sr{};
    double sum_of_logs{};  ///< Sum of the logarithms of the firings' ranges in metres.

    /// Geometric mean of the firings' ranges, which need not be centred in the bin.
    [[nodiscard]] double range_m() const {
      return std::exp(sum_of_logs / static_cast<double>(num_firings));
    }
    void Add(const Count& other);
  };
  /// By bin of FineRangeBins().
  using Curve = std::vector<Count>;

  [[nodiscard]] bool is_empty() const { return by_label_.empty() && by_attitude_.empty(); }
  /// Power law fitted to the bins with at least kMinSamples points.
  [[nodiscard]] static PowerLaw LawOf(const Curve& curve);
  /// By label, from the truth.
  [[nodiscard]] const std::map<std::uint32_t, Curve>& by_label() const { return by_label_; }
  /// By "level", "slanted" or "upright", from the points alone.
  [[nodiscard]] const std::map<std::string, Curve>& by_attitude() const { return by_attitude_; }

  [[nodiscard]] Section MakeSection(const Names& names) const;

 private:
  void AddFromTruth(const RecordedFrame& recorded, const ScanTable& scan);
  void AddFromPoints(const Frame& frame, const ScanTable& scan);

  std::map<std::uint32_t, Curve> by_label_;
  std::map<std::string, Curve> by_attitude_;
};

}  // namespace railcast
