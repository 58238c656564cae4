#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/io/recording/scan_table.h"

namespace railcast {

/// Finds columns of a grid by azimuth.
class ColumnFinder {
 public:
  explicit ColumnFinder(const ScanTable& scan) {
    for (std::size_t column = 0; column < scan.columns; ++column) {
      const double azimuth_rad = scan.column_azimuth_rad[column];
      if (!std::isnan(azimuth_rad)) places_.emplace_back(Turned(azimuth_rad), column);
    }
    std::sort(places_.begin(), places_.end());
  }
  struct Found {
    std::size_t column{};
    double offset_rad{};  ///< Azimuth asked for minus that of this column.
  };
  [[nodiscard]] std::optional<Found> Nearest(double azimuth_rad) const {
    if (places_.empty()) return std::nullopt;
    const auto above = std::lower_bound(places_.begin(), places_.end(),
                                        std::pair(Turned(azimuth_rad), std::size_t{0}));
    const auto& high = above == places_.end() ? places_.front() : *above;
    const auto& low = above == places_.begin() ? places_.back() : *std::prev(above);
    const double to_high_rad = WrappedAngle_rad(azimuth_rad - high.first);
    const double to_low_rad = WrappedAngle_rad(azimuth_rad - low.first);
    if (std::abs(to_high_rad) < std::abs(to_low_rad)) return Found{high.second, to_high_rad};
    return Found{low.second, to_low_rad};
  }

 private:
  // Wraps an angle to [0, 2 pi).
  static double Turned(double angle_rad) {
    const double wrapped_rad = WrappedAngle_rad(angle_rad);
    return wrapped_rad < 0.0 ? wrapped_rad + 2.0 * std::numbers::pi : wrapped_rad;
  }

  std::vector<std::pair<double, std::size_t>> places_;
};

}  // namespace railcast
