#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "generator/extras/osi/sensor_view.h"

namespace railcast::osi {

std::vector<std::uint32_t> FiringsByRay(const ScanPattern& pattern) {
  const std::size_t num_firings = pattern.num_firings();
  std::vector<float> azimuth_rad(num_firings);
  for (std::size_t i = 0; i < num_firings; ++i) {
    azimuth_rad[i] = std::atan2(pattern.direction_y[i], pattern.direction_x[i]);
  }
  std::vector<std::uint32_t> firings(num_firings);
  std::iota(firings.begin(), firings.end(), 0U);
  std::ranges::stable_sort(firings, [&](std::uint32_t a, std::uint32_t b) {
    if (pattern.row[a] != pattern.row[b]) return pattern.row[a] > pattern.row[b];
    return azimuth_rad[a] > azimuth_rad[b];
  });
  return firings;
}

}  // namespace railcast::osi
