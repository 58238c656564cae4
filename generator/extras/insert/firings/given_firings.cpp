#include "generator/extras/insert/firings/given_firings.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace railcast {

ScanPattern PatternOfFirings(const ScanPattern& shape, std::vector<GivenFiring> firings) {
  std::ranges::sort(firings, {}, [](const GivenFiring& firing) {
    return std::tuple(firing.time_ns, firing.row, firing.column);
  });
  ScanPattern pattern;
  pattern.rate_hz = shape.rate_hz;
  pattern.rows = shape.rows;
  pattern.columns = shape.columns;
  const bool has_origins = std::ranges::any_of(
      firings, [](const GivenFiring& firing) { return firing.origin_m != std::array<float, 3>{}; });
  std::vector<std::uint32_t> at(std::size_t{shape.rows} + 1);
  for (const GivenFiring& firing : firings) {
    pattern.direction_x.push_back(firing.direction[0]);
    pattern.direction_y.push_back(firing.direction[1]);
    pattern.direction_z.push_back(firing.direction[2]);
    pattern.time_ns.push_back(firing.time_ns);
    pattern.row.push_back(firing.row);
    pattern.column.push_back(firing.column);
    ++at[firing.row + std::size_t{1}];
    if (!has_origins) continue;
    pattern.origin_x_m.push_back(firing.origin_m[0]);
    pattern.origin_y_m.push_back(firing.origin_m[1]);
    pattern.origin_z_m.push_back(firing.origin_m[2]);
  }
  std::partial_sum(at.begin(), at.end(), at.begin());
  pattern.packet_order.resize(firings.size());
  for (std::uint32_t i = 0; i < firings.size(); ++i) {
    pattern.packet_order[at[firings[i].row]++] = i;
  }
  while (pattern.packet_order.size() % kPacketSize != 0) {
    pattern.packet_order.push_back(pattern.packet_order.back());
  }
  return pattern;
}

}  // namespace railcast
