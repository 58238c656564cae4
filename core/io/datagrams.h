#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "railcast/frame.h"

namespace railcast {

/// Simulation time 0 in seconds since 1970: 2000-01-01 00:00:00 UTC.
inline constexpr std::int64_t kSimulationEpoch_s = 946'684'800;

/// The port of a receiver that a datagram is sent to.
enum class DatagramPort : std::uint8_t {
  kData,
  kPosition,  ///< Port 8308, where Velodyne sensors report their time and position.
};

/// Datagrams in the order in which they leave. They share one buffer, so that runs of equal size
/// can be handed to the kernel at once.
struct Datagrams {
  struct Item {
    std::size_t offset{};
    std::uint32_t size{};
    DatagramPort port{};
    /// Simulation time of the last firing in the datagram; a real sensor could not send it earlier.
    std::int64_t due_ns{};
    /// For a message for ROS 2, what takes the place of a datagram; for a recorded datagram, the
    /// port that it was sent to.
    std::uint16_t topic{};
  };
  std::vector<char> bytes;
  std::vector<Item> items;

  [[nodiscard]] std::span<const char> BytesOf(const Item& item) const {
    return std::span(bytes).subspan(item.offset, item.size);
  }
  /// Appends a datagram.
  /// @param item All but where its bytes are, which is set.
  void Append(std::span<const char> datagram, Item item) {
    item.offset = bytes.size();
    item.size = static_cast<std::uint32_t>(datagram.size());
    items.push_back(item);
    bytes.insert(bytes.end(), datagram.begin(), datagram.end());
  }
  /// Removes all datagrams but keeps the allocated memory.
  void Clear() {
    bytes.clear();
    items.clear();
  }
};

/// Turns frames into the datagrams that a sensor sends.
class FrameEncoder {
 public:
  virtual ~FrameEncoder() = default;

  /// Sets how far the clock whose time is stated is ahead of simulation time, which begins with 0
  /// in the railcast protocol, in packets of sensors at 2000-01-01 00:00:00 UTC. It is not ahead
  /// unless set.
  void SetClockAhead(std::int64_t ahead_ns) { clock_ahead_ns_ = ahead_ns; }

  /// Appends the datagrams that this frame completes, by rising `due_ns`. Frames must come in
  /// order. A vendor's packet may span two frames: a packet that one frame leaves unfinished is
  /// completed by the next. If frames between two others are left out, every datagram that would
  /// contain a part of them is left out as well; all other datagrams are unaffected.
  virtual void Encode(const Frame& frame, Datagrams& datagrams) = 0;

 protected:
  [[nodiscard]] std::int64_t clock_ahead_ns() const { return clock_ahead_ns_; }

 private:
  std::int64_t clock_ahead_ns_{};
};

/// A file that datagrams are captured into as they are due.
class DatagramFile {
 public:
  virtual ~DatagramFile() = default;

  /// Sets how far the stamps are ahead of simulation time, as FrameEncoder::SetClockAhead() does.
  virtual void SetClockAhead(std::int64_t ahead_ns) = 0;
  /// Appends these datagrams.
  /// @throws InputError if the system refuses, as on a full disk. The file must then not be used
  ///   any more.
  virtual void Write(const Datagrams& datagrams, std::span<const Datagrams::Item> items) = 0;
  /// Completes the file.
  /// @throws InputError if the system refuses.
  virtual void Finish() = 0;
  /// The file that holds the datagrams until Finish().
  [[nodiscard]] virtual std::filesystem::path unfinished() const = 0;
};

}  // namespace railcast
