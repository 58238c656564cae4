#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>

#include "core/io/stream/udp_grabber.h"

namespace railcast {

/// The latest frame of a live stream in the railcast protocol.
class LiveFrames {
 public:
  /// Listens from now on.
  /// @throws InputError if the port cannot be listened to.
  explicit LiveFrames(const Endpoint& at);

  [[nodiscard]] Endpoint at() const { return grabber_.at(); }
  /// Waits, for ever, for the first complete frame.
  [[nodiscard]] std::shared_ptr<const ReceivedFrame> WaitForWhole();
  /// The last frame that came since this was last asked; null if there is none.
  [[nodiscard]] std::shared_ptr<const ReceivedFrame> TakeLatest();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const ReceivedFrame> latest_;
  UdpGrabber grabber_;  ///< Ends before what its callback uses.
};

}  // namespace railcast
