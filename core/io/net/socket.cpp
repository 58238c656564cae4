#include "core/io/net/socket.h"

#include <netinet/in.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include "core/base/error.h"

namespace railcast {
namespace {

in_addr Ipv4Of(const IpAddress& address) {
  return {htonl(address.ipv4())};
}

in6_addr Ipv6Of(const IpAddress& address) {
  in6_addr ipv6{};
  std::ranges::copy(address.bytes, ipv6.s6_addr);
  return ipv6;
}

template <typename Address>
SocketAddress Stored(const Address& address) {
  SocketAddress stored;
  std::memcpy(&stored.storage, &address, sizeof address);
  stored.size = sizeof address;
  return stored;
}

ip_mreqn Membership(const IpAddress& group) {
  ip_mreqn membership{};
  membership.imr_multiaddr = Ipv4Of(group);
  membership.imr_ifindex = static_cast<int>(group.interface);
  return membership;
}

}  // namespace

SocketAddress SocketAddressOf(const Endpoint& endpoint) {
  if (endpoint.address.is_ipv4()) {
    sockaddr_in ipv4{};
    ipv4.sin_family = AF_INET;
    ipv4.sin_addr = Ipv4Of(endpoint.address);
    ipv4.sin_port = htons(endpoint.port);
    return Stored(ipv4);
  }
  sockaddr_in6 ipv6{};
  ipv6.sin6_family = AF_INET6;
  ipv6.sin6_addr = Ipv6Of(endpoint.address);
  ipv6.sin6_port = htons(endpoint.port);
  ipv6.sin6_scope_id = endpoint.address.interface;
  return Stored(ipv6);
}

Endpoint EndpointOf(const SocketAddress& address) {
  if (address.storage.ss_family == AF_INET) {
    sockaddr_in ipv4{};
    std::memcpy(&ipv4, &address.storage, sizeof ipv4);
    return {ntohl(ipv4.sin_addr.s_addr), ntohs(ipv4.sin_port)};
  }
  sockaddr_in6 ipv6{};
  std::memcpy(&ipv6, &address.storage, sizeof ipv6);
  Endpoint endpoint{{}, ntohs(ipv6.sin6_port)};
  std::ranges::copy(ipv6.sin6_addr.s6_addr, endpoint.address.bytes.begin());
  endpoint.address.interface = ipv6.sin6_scope_id;
  return endpoint;
}

UdpSocket::UdpSocket(const IpAddress& family)
    : socket_(::socket(
          family.is_ipv4() ? AF_INET : AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (!socket_.is_open()) throw InputError("no socket: " + std::string(std::strerror(errno)));
}

UdpSocket SocketTo(const Endpoint& to, int multicast_hops) {
  UdpSocket socket(to.address);
  const int yes = 1;
  if (to.is_broadcast()) static_cast<void>(socket.Set(SOL_SOCKET, SO_BROADCAST, yes));
  if (!to.address.is_multicast()) return socket;
  // A group that cannot be reached so is found out by who sends there.
  const auto interface = static_cast<int>(to.address.interface);
  if (to.address.is_ipv4()) {
    if (interface != 0) {
      static_cast<void>(socket.Set(IPPROTO_IP, IP_MULTICAST_IF, Membership(to.address)));
    }
    static_cast<void>(socket.Set(IPPROTO_IP, IP_MULTICAST_TTL, multicast_hops));
  } else {
    if (interface != 0) static_cast<void>(socket.Set(IPPROTO_IPV6, IPV6_MULTICAST_IF, interface));
    static_cast<void>(socket.Set(IPPROTO_IPV6, IPV6_MULTICAST_HOPS, multicast_hops));
  }
  return socket;
}

bool JoinGroup(const UdpSocket& socket, const IpAddress& group) {
  if (group.is_ipv4()) return socket.Set(IPPROTO_IP, IP_ADD_MEMBERSHIP, Membership(group));
  const ipv6_mreq membership{Ipv6Of(group), group.interface};
  return socket.Set(IPPROTO_IPV6, IPV6_JOIN_GROUP, membership);
}

}  // namespace railcast
