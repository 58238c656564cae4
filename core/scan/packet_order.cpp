#include "core/scan/packet_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "railcast/lidar.h"

namespace railcast {
namespace {

/// Number of firings, in order of elevation, that form a band as high as the square covered by the
/// firings of one packet.
///
/// If n firings cover a x e (azimuth x elevation), each takes a e / n. A square of p firings has
/// the side sqrt(p a e / n), and a band of that height holds n / e times as many: sqrt(p n a / e).
std::size_t BandSize(const FiringGrid& grid) {
  const auto [left, right] = std::ranges::minmax(grid.firings, {}, &Firing::azimuth_rad);
  const auto [low, high] = std::ranges::minmax(grid.firings, {}, &Firing::elevation_rad);
  const double width_rad = right.azimuth_rad - left.azimuth_rad;
  const double height_rad = high.elevation_rad - low.elevation_rad;
  const auto num_firings = static_cast<double>(grid.firings.size());
  const double whole_rows = grid.rows > 1 ? grid.columns : 1;
  const double size = std::sqrt(kPacketSize * num_firings * width_rad / height_rad);
  if (!(size < num_firings)) return grid.firings.size();  // True also if the height is 0.
  return static_cast<std::size_t>(std::max(1.0, std::round(size / whole_rows)) * whole_rows);
}

}  // namespace

std::vector<std::uint32_t> PacketOrder(const FiringGrid& grid) {
  const std::vector<Firing>& firings = grid.firings;
  std::vector<std::uint32_t> order(firings.size());
  std::iota(order.begin(), order.end(), 0U);
  if (order.empty()) return order;

  std::ranges::sort(order, {}, [&](std::uint32_t i) {
    return std::tuple(firings[i].elevation_rad, firings[i].row, i);
  });
  const std::size_t band_size = BandSize(grid);
  bool leftward = false;
  for (std::size_t begin = 0; begin < order.size(); begin += band_size) {
    const std::size_t end = std::min(begin + band_size, order.size());
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
              order.begin() + static_cast<std::ptrdiff_t>(end),
              [&](std::uint32_t i, std::uint32_t j) {
                const double to_right_rad = firings[j].azimuth_rad - firings[i].azimuth_rad;
                if (to_right_rad != 0.0) return leftward ? to_right_rad > 0.0 : to_right_rad < 0.0;
                return i < j;
              });
    leftward = !leftward;
  }
  const std::uint32_t last = order.back();
  while (order.size() % kPacketSize != 0) order.push_back(last);
  return order;
}

}  // namespace railcast
