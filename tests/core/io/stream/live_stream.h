#pragma once

#include <chrono>
#include <functional>
#include <thread>

#include "core/io/net/udp.h"
#include "tests/core/io/stream/stream_example.h"
#include "tests/support/loopback.h"

namespace railcast {

/// Sends example frames to a port of this machine.
class LiveStream {
 public:
  explicit LiveStream(const Endpoint& to, const StreamSpec& spec = {})
      : encoder_(StreamPattern(), spec), sender_({to}, 0) {}

  /// Begins anew with the same socket.
  void Restart(const StreamSpec& spec) { encoder_ = StreamEncoder(StreamPattern(), spec); }
  /// As FrameEncoder::SetClockAhead().
  void SetClockAhead(std::int64_t ahead_ns) { encoder_.SetClockAhead(ahead_ns); }

  void Send(std::uint32_t index) {
    datagrams_.Clear();
    encoder_.Encode(StreamFrame(index), datagrams_);
    sender_.Send(datagrams_, datagrams_.items);
  }

  /// Sends all but one of the frame's datagrams.
  void SendWithout(std::uint32_t index, std::size_t lost) {
    datagrams_.Clear();
    encoder_.Encode(StreamFrame(index), datagrams_);
    const std::span<const Datagrams::Item> items = datagrams_.items;
    sender_.Send(datagrams_, items.first(lost));
    sender_.Send(datagrams_, items.subspan(lost + 1));
  }
  /// Sends the datagram that SendWithout leaves out.
  void SendOnly(std::uint32_t index, std::size_t lost) {
    datagrams_.Clear();
    encoder_.Encode(StreamFrame(index), datagrams_);
    sender_.Send(datagrams_, std::span(datagrams_.items).subspan(lost, 1));
  }

 private:
  StreamEncoder encoder_;
  UdpSender sender_;
  Datagrams datagrams_;
};

/// Waits until a condition is true. The wait is long, because a loaded machine may be slow.
inline bool Eventually(const std::function<bool()>& is_true) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::seconds(20);
  while (!is_true()) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace railcast
