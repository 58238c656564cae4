#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/io/datagrams.h"
#include "core/io/net/socket.h"
#include "railcast/io/endpoint.h"

namespace railcast {

/// A UDP port that is listened to. Another thread may interrupt a thread that waits for a datagram.
/// Datagrams that were sent in one call on this machine, or that a network card has put together,
/// are taken from the kernel in one call, too, where it can (UDP GRO).
class UdpReceiver {
 public:
  /// @param at Loopback accepts datagrams from this machine only, 0.0.0.0 those of IPv4 from all,
  ///   [::] those of IPv6, and a multicast group, which is joined, those that are sent to it. Port
  ///   0 takes a free port.
  /// @throws InputError if the port is taken or not allowed, or if the group cannot be joined.
  explicit UdpReceiver(const Endpoint& at);

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

  UdpSocket socket_;
  FileDescriptor wake_;
  Endpoint at_;
  std::vector<char> buffer_;
  std::span<const char> waiting_;  ///< Datagrams that were taken together, in `buffer_`.
  std::size_t segment_size_{};     ///< Size of each; the last one may be smaller.
  Endpoint from_;
  mutable std::atomic<bool> is_ended_ = false;
};

struct SendOptions {
  /// Whether runs of datagrams may be handed over in one call, to be cut by the kernel or the
  /// network card. A capture on the sending machine then holds runs instead of single datagrams.
  bool has_offload = true;
  /// Networks on which what is sent to multicast groups may be: 1 = this one, no router passes it
  /// on.
  int multicast_hops = 1;
};

/// Sends datagrams to a list of receivers and never waits for any of them.
///
/// A receiver is a loopback or unicast address, a multicast group, whose datagrams leave by the
/// interface that it names or where the routing table says, or 255.255.255.255 if that is given
/// explicitly; the kernel refuses the broadcast addresses of single networks. Each receiver is sent
/// to from a port of its own.
class UdpSender {
 public:
  /// @param position_port Port of every receiver for datagrams that are DatagramPort::kPosition.
  /// @throws InputError if a receiver cannot be sent to.
  UdpSender(const std::vector<Endpoint>& to,
            std::uint16_t position_port,
            const SendOptions& options = {});

  /// Sends these datagrams to every receiver. With offload, and where the kernel has UDP GSO (Linux
  /// 4.18), each run of equal size goes out in one call; otherwise datagrams go out one by one.
  void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items);

  /// Numbers of datagrams that left, counted once for each receiver, and of those that the kernel
  /// refused because of a full queue or because it had no route to the receiver.
  struct Counts {
    std::uint64_t sent{};
    std::uint64_t refused{};
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  struct Target {
    UdpSocket socket;
    Endpoint to;
  };
  void SendRun(std::span<const char> run,
               std::size_t segment_size,
               const UdpSocket& socket,
               SocketAddress to);

  std::vector<Target> targets_;
  std::uint16_t position_port_;
  bool has_gso_;
  Counts counts_;
};

}  // namespace railcast
