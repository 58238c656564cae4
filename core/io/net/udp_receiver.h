#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "railcast/io/stream.h"

namespace railcast {

/// A UDP port that is listened to. Another thread may interrupt a thread that waits for a datagram.
/// Datagrams that were sent in one call on this machine, or that a network card has put together,
/// are taken from the kernel in one call, too, where it can (UDP GRO).
class UdpReceiver {
 public:
  /// @param at Loopback accepts datagrams from this machine only, 0.0.0.0 from all; port 0 takes a
  ///   free port.
  /// @throws InputError if the port is taken or not allowed.
  explicit UdpReceiver(const Endpoint& at);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  [[nodiscard]] const Endpoint& at() const { return at_; }

  struct Received {
    std::span<const char> bytes;  ///< Valid until the next call.
    Endpoint from;
  };
  /// Returns the next datagram, or nothing if none came within `timeout_ms` or the receiver was
  /// interrupted.
  [[nodiscard]] std::optional<Received> Receive(int timeout_ms);
  /// Ends the current call of Receive and every later one at once. Thread-safe, and safe in a
  /// signal handler.
  void Interrupt() const;
  [[nodiscard]] bool is_interrupted() const;

  /// Sends an answer from this port. An answer that the kernel does not take at once is lost, as it
  /// could be on a network.
  void Answer(std::span<const char> bytes, const Endpoint& to) const;

 private:
  [[nodiscard]] bool TakeFromSocket();
  [[nodiscard]] Received NextWaiting();

  int socket_ = -1;
  int wake_ = -1;
  Endpoint at_;
  std::vector<char> buffer_;
  std::span<const char> waiting_;  ///< Datagrams that were taken together, in `buffer_`.
  std::size_t segment_size_{};     ///< Size of each; the last one may be smaller.
  Endpoint from_;
  mutable std::atomic<bool> is_ended_ = false;
};

}  // namespace railcast
