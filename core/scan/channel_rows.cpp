#include "core/scan/channel_rows.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace railcast {

std::vector<std::uint16_t> RowsByElevation(const std::vector<ChannelSpec>& channels) {
  std::vector<std::size_t> by_elevation(channels.size());
  std::iota(by_elevation.begin(), by_elevation.end(), std::size_t{0});
  std::ranges::stable_sort(by_elevation, {},
                           [&](std::size_t i) { return channels[i].elevation_deg; });
  std::vector<std::uint16_t> rows(channels.size());
  for (std::size_t rank = 0; rank < rows.size(); ++rank) {
    rows[by_elevation[rank]] = static_cast<std::uint16_t>(rank);
  }
  return rows;
}

}  // namespace railcast
