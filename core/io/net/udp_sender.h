#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/io/datagrams.h"
#include "railcast/io/stream.h"

namespace railcast {

/// Sends datagrams to a list of receivers and never waits for any of them.
///
/// A receiver is a loopback or unicast address, or 255.255.255.255 if that is given explicitly; the
/// kernel refuses the broadcast addresses of single networks.
class UdpSender {
 public:
  /// @param position_port Port of every receiver for datagrams that are DatagramPort::kPosition.
  /// @param has_offload Whether runs of datagrams may be handed over in one call, to be cut by the
  ///   kernel or the network card. A capture on the sending machine then holds runs instead of
  ///   single datagrams.
  /// @throws InputError if a receiver cannot be sent to.
  UdpSender(std::vector<Endpoint> to, std::uint16_t position_port, bool has_offload = true);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

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
  void SendRun(const char* bytes, std::size_t size, std::size_t segment_size, const Endpoint& to);

  std::vector<Endpoint> to_;
  std::uint16_t position_port_;
  int socket_ = -1;
  bool has_gso_;
  Counts counts_;
};

}  // namespace railcast
