#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/io/datagrams.h"
#include "core/io/net/endpoint.h"

namespace railcast {

/// Sends datagrams to a list of receivers and never waits for any of them.
///
/// Only loopback, unicast and, asked for by its name, 255.255.255.255: the kernel refuses the
/// broadcast addresses of single networks.
class UdpSender {
 public:
  /// @param position_port Of every receiver, for datagrams that are DatagramPort::kPosition.
  /// @param has_offload Whether runs of datagrams may be handed over in one call, to be cut by the
  ///   kernel or the card. Captures on the sending machine then hold runs in place of datagrams.
  /// @throws InputError if a receiver cannot be sent to.
  UdpSender(std::vector<Endpoint> to, std::uint16_t position_port, bool has_offload = true);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// Sends these to every receiver: with offload runs of equal size in one call each where the
  /// kernel has UDP GSO (Linux 4.18), else one by one.
  void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items);

  /// Datagrams that left, counted once for each receiver, and those that the kernel refused: a full
  /// queue or no way to the receiver.
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
