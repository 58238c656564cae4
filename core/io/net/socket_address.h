#pragma once

#include <netinet/in.h>

#include "railcast/io/stream.h"

namespace railcast {

[[nodiscard]] inline sockaddr_in SocketAddressOf(const Endpoint& endpoint) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(endpoint.address);
  address.sin_port = htons(endpoint.port);
  return address;
}

[[nodiscard]] inline Endpoint EndpointOf(const sockaddr_in& address) {
  return {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)};
}

}  // namespace railcast
