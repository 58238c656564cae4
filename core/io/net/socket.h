#pragma once

#include <sys/socket.h>

#include <cstdint>

#include "core/base/file_descriptor.h"
#include "railcast/io/endpoint.h"

namespace railcast {

/// An endpoint as the kernel takes it, and gives it.
struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = sizeof storage;

  [[nodiscard]] sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
};
[[nodiscard]] SocketAddress SocketAddressOf(const Endpoint& endpoint);
[[nodiscard]] Endpoint EndpointOf(const SocketAddress& address);

/// A UDP socket that is open while the object lives, and never waits.
class UdpSocket {
 public:
  /// @param family Of which addresses it is.
  /// @throws InputError if the system has none, as a machine without IPv6.
  explicit UdpSocket(const IpAddress& family);

  [[nodiscard]] int get() const { return socket_.number(); }

  template <typename Value>
  [[nodiscard]] bool Set(int level, int option, const Value& value) const {
    return ::setsockopt(get(), level, option, &value, sizeof value) == 0;
  }

 private:
  FileDescriptor socket_;
};

/// Makes a socket that is to send to an endpoint: it may broadcast where that is a broadcast, and
/// reaches a group by the interface that its address names.
/// @param multicast_hops As SendOptions::multicast_hops.
[[nodiscard]] UdpSocket SocketTo(const Endpoint& to, int multicast_hops);

/// Lets a socket hear a group.
/// @returns Whether the system does, else errno says why not.
[[nodiscard]] bool JoinGroup(const UdpSocket& socket, const IpAddress& group);

}  // namespace railcast
