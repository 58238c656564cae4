#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/io/net/endpoint.h"

namespace railcast {

/// A UDP port that is listened to. Another thread may interrupt who waits at it.
class UdpReceiver {
 public:
  /// @param at Loopback listens to this machine alone, 0.0.0.0 to all; port 0 takes a free one.
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
  /// The next datagram; nothing after `timeout_ms` without one, or once interrupted.
  [[nodiscard]] std::optional<Received> Receive(int timeout_ms);
  /// Ends the current and every later Receive at once. Thread-safe, and safe in a signal handler.
  void Interrupt() const;
  [[nodiscard]] bool is_interrupted() const;

  /// Answers from this port; what the kernel does not take at once is lost, as on a network.
  void Answer(std::span<const char> bytes, const Endpoint& to) const;

 private:
  int socket_ = -1;
  int wake_ = -1;
  Endpoint at_;
  std::vector<char> buffer_;
};

}  // namespace railcast
