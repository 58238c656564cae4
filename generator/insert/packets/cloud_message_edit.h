#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "generator/insert/inserted_frame.h"
#include "generator/insert/recorded_firings.h"

namespace railcast {

/// A message with edits, and what its points are.
struct EditedCloudMessage {
  std::vector<std::byte> data;
  /// For each of its points the slot; kNoSlot for places that belong to none.
  std::vector<std::uint32_t> slots;
};

/// Puts the edits of a frame into the message of type sensor_msgs/msg/PointCloud2 that it was read
/// from. Points that nothing touched keep their bytes. Rows and columns of an organised cloud stay,
/// with points that are absent marked; of others, points are left out and added.
/// @param data With CDR's header; so is the result, which is little-endian.
[[nodiscard]] EditedCloudMessage EditCloudMessage(std::span<const std::byte> data,
                                                  const RecordedFirings& firings,
                                                  const InsertedFrame& inserted);

}  // namespace railcast
