#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace railcast {

/// Where the bytes of a datagram stand among those that have arrived.
struct Arrival {
  std::uint32_t packet{};
  std::size_t offset{};
  std::size_t size{};
};

/// Sorts arrivals by packet and returns their bytes in that order.
/// @param bytes In the order of arrival; a container of char, which is moved from if possible.
template <typename Bytes>
[[nodiscard]] Bytes JoinArrivals(std::vector<Arrival>& arrivals, Bytes& bytes) {
  if (std::ranges::is_sorted(arrivals, {}, &Arrival::packet)) return std::move(bytes);
  std::ranges::sort(arrivals, {}, &Arrival::packet);
  Bytes joined;
  joined.reserve(bytes.size());
  for (const Arrival& arrival : arrivals) {
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(arrival.offset);
    joined.insert(joined.end(), begin, begin + static_cast<std::ptrdiff_t>(arrival.size));
  }
  return joined;
}

}  // namespace railcast
