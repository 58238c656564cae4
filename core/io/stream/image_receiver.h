#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/io/net/udp_receiver.h"
#include "core/io/stream/image_assembler.h"
#include "railcast/io/stream.h"

namespace railcast {

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
