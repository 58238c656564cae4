#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/io/stream/stream_format.h"

namespace railcast {

/// The numbers [first, first + count).
struct IndexRange {
  std::uint32_t first{};
  std::uint32_t count{};
  bool operator==(const IndexRange&) const = default;
};

/// What arrived of one frame, and what did not.
struct ReceivedFrame {
  StreamHeader header;
  std::uint32_t num_packets{};  ///< Of the frame, whether or not they arrived.
  std::vector<char> points;     ///< Those that arrived: point_size bytes each, in firing order.
  std::vector<IndexRange> lost_packets;
  std::vector<IndexRange> lost_points;  ///< Of the frame's header.num_points.

  [[nodiscard]] bool is_complete() const { return lost_packets.empty(); }
  /// Those that arrived.
  [[nodiscard]] std::size_t num_points() const { return points.size() / header.point_size; }
  [[nodiscard]] std::uint32_t num_lost_packets() const;

  /// A field of the `i`th point that arrived. @pre `field` is of this frame, `T` its type.
  template <typename T>
  [[nodiscard]] T At(const StreamField& field, std::size_t i) const {
    T value;
    std::memcpy(&value, &points[i * header.point_size + field.offset], sizeof value);
    return value;
  }
};

}  // namespace railcast
