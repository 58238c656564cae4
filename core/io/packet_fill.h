#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace railcast {

/// Counts the blocks of packets that span frames. Of frames that are left out, their packets are
/// left out, too, and all others are as if every frame had come.
class PacketFill {
 public:
  explicit PacketFill(std::size_t blocks_per_packet) : blocks_per_packet_(blocks_per_packet) {}

  /// Counts the frames that were left out since the last one.
  /// @param frame Its number; numbers rise.
  void BeginFrame(std::uint32_t frame, std::uint64_t blocks_per_frame) {
    if (next_frame_ && frame > *next_frame_) {
      total_ += blocks_per_frame * (frame - *next_frame_);
      lacks_blocks_ = num_blocks() > 0;
    }
    next_frame_ = frame + 1;
  }

  /// Returns whether these blocks complete a packet that lacks none.
  [[nodiscard]] bool Add(std::size_t num_blocks_added) {
    total_ += num_blocks_added;
    if (num_blocks() > 0) return false;
    const bool is_whole = !lacks_blocks_;
    lacks_blocks_ = false;
    return is_whole;
  }

  /// Number of blocks in the packet under construction.
  [[nodiscard]] std::size_t num_blocks() const {
    return static_cast<std::size_t>(total_ % blocks_per_packet_);
  }
  /// Number of packets before the one under construction, those left out included.
  [[nodiscard]] std::uint64_t num_packets() const { return total_ / blocks_per_packet_; }

 private:
  std::size_t blocks_per_packet_;
  std::uint64_t total_{};  ///< Blocks.
  bool lacks_blocks_ = false;
  std::optional<std::uint32_t> next_frame_;
};

}  // namespace railcast
