#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/frame/frame.h"

namespace railcast {

/// Which of a receiver's ports a datagram is for.
enum class DatagramPort : std::uint8_t {
  kData,
  kPosition,  ///< Where Velodyne sensors say their time and place: 8308.
};

/// Datagrams in the order in which they leave; one buffer, so that runs of equal size can be handed
/// to the kernel at once.
struct Datagrams {
  struct Item {
    std::size_t offset{};
    std::uint16_t size{};
    DatagramPort port{};
    /// Simulation time of the last firing in it: a real sensor could not send it earlier.
    std::int64_t due_ns{};
  };
  std::vector<char> bytes;
  std::vector<Item> items;

  [[nodiscard]] std::span<const char> BytesOf(const Item& item) const {
    return std::span(bytes).subspan(item.offset, item.size);
  }
  /// Keeps the memory.
  void Clear() {
    bytes.clear();
    items.clear();
  }
};

/// Turns frames into what a sensor sends.
class FrameEncoder {
 public:
  virtual ~FrameEncoder() = default;

  /// Appends the datagrams that this frame completes, by rising `due_ns`. Frames come in order.
  /// What a frame leaves unfinished, as vendors' packets do, the next one completes. If frames are
  /// left out between two, so is every datagram that has a part of them, and the others are as
  /// ever.
  virtual void Encode(const Frame& frame, Datagrams& datagrams) = 0;
};

}  // namespace railcast
