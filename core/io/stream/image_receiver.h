#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/io/image/png.h"
#include "core/io/net/udp.h"
#include "core/io/stream/arrivals.h"
#include "core/io/stream/stream_datagram.h"
#include "railcast/io/stream.h"

namespace railcast {

/// An image all of whose datagrams arrived.
struct ReceivedImage {
  std::uint32_t run{};
  std::uint32_t frame{};  ///< Number of the sensor's frame with the same stamp.
  std::int64_t stamp_ns{};
  ImageSize size;  ///< As the datagrams say it; at most kMostPixels. The file may differ.
  std::string jpeg;
};

/// Statistics of a receiver of images.
struct ImageCounts {
  std::uint64_t complete_images{};
  std::uint64_t incomplete_images{};  ///< Given up, because some of their packets did not come.
  std::uint64_t received_packets{};   ///< Valid packets, with duplicate and late ones.
  std::uint64_t stray_packets{};      ///< Valid packets of an earlier run or of an image long past.
  std::uint64_t other_sender_packets{};
  std::uint64_t refused_packets{};  ///< Not of this protocol, damaged, or contradictory.
};

/// Reassembles images from datagrams that may be lost, duplicated, reordered, damaged or forged.
///
/// An image is given as soon as it is complete, and only then, in the order of their numbers. An
/// incomplete one is given up as soon as a later one is complete or two later ones have begun. So
/// at most two images are open, and memory is in proportion to what arrived, whatever a datagram
/// claims. Senders and runs are followed as by FrameAssembler.
class ImageAssembler {
 public:
  /// @param from Senders that this endpoint covers; absent: the first one heard.
  explicit ImageAssembler(const std::optional<Endpoint>& from = {}) : sender_(from) {}

  /// Takes a datagram and appends to `images` the one that it completes.
  void Take(std::span<const char> datagram,
            std::vector<ReceivedImage>& images,
            const DatagramOrigin& origin = {});

  [[nodiscard]] const ImageCounts& counts() const { return counts_; }

 private:
  struct OpenImage {
    ImageHead whole;  ///< What its datagrams share.
    std::uint32_t bytes_each{};
    std::vector<bool> has_packet;
    std::vector<Arrival> pieces;
    std::string bytes;  ///< In the order of arrival.
  };

  [[nodiscard]] bool IsPast(const ImageDatagram& datagram) const;
  [[nodiscard]] bool FollowsOn(const ImageDatagram& datagram) const;
  [[nodiscard]] bool BeginsAnew(const ImageDatagram& datagram);
  void Store(const ImageDatagram& datagram, std::vector<ReceivedImage>& images);
  void GiveUpFirst();

  ImageCounts counts_;
  FollowedSender sender_;
  std::optional<std::uint32_t> run_;
  std::uint32_t num_strays_{};  ///< Number of strays in a row.
  std::map<std::uint32_t, OpenImage> open_;
  std::optional<std::uint32_t> last_closed_;  ///< The last image that was given or given up.
};

/// Receives a camera's images in the railcast protocol on a thread of its own.
class ImageReceiver {
 public:
  /// If the consumer is too slow, the oldest images are dropped.
  static constexpr std::size_t kMaxWaitingImages = 4;

  /// @param from As for ImageAssembler.
  /// @throws InputError if the port cannot be opened.
  explicit ImageReceiver(const Endpoint& at, const std::optional<Endpoint>& from = {});
  ~ImageReceiver();
  ImageReceiver(const ImageReceiver&) = delete;
  ImageReceiver& operator=(const ImageReceiver&) = delete;

  [[nodiscard]] const Endpoint& at() const { return socket_.at(); }
  /// Returns the images that have come since the last call, in the order of their numbers.
  /// Thread-safe.
  [[nodiscard]] std::vector<ReceivedImage> Take();
  /// Thread-safe.
  [[nodiscard]] ImageCounts counts() const;

 private:
  void Listen();

  UdpReceiver socket_;
  std::atomic<bool> is_stopping_{false};
  mutable std::mutex mutex_;  ///< Guards the assembler and the images.
  ImageAssembler assembler_;
  std::vector<ReceivedImage> waiting_;
  /// The last member, so that all that it uses is there when it starts.
  std::thread thread_;
};

}  // namespace railcast
