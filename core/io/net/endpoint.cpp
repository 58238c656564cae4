#include "core/io/net/endpoint.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <charconv>

#include "core/base/error.h"

namespace railcast {
namespace {

std::uint16_t ParsePort(std::string_view text, std::string_view whole) {
  unsigned port = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, port);
  if (result.ec != std::errc() || result.ptr != end || port == 0 || port > 65535) {
    throw InputError("the port must be a whole number from 1 to 65535 (got " + std::string(whole) +
                     ")");
  }
  return static_cast<std::uint16_t>(port);
}

std::uint32_t ParseHost(const std::string& host, std::string_view whole) {
  // A minimal system has no /etc/hosts that knows it (RFC 6761, 6.3).
  if (host == "localhost") return INADDR_LOOPBACK;
  in_addr address{};
  if (::inet_pton(AF_INET, host.c_str(), &address) == 1) return ntohl(address.s_addr);
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0 || found == nullptr) {
    throw InputError("must be HOST:PORT with an IPv4 address or a known name (got " +
                     std::string(whole) + ")");
  }
  const auto* socket_address = reinterpret_cast<const sockaddr_in*>(found->ai_addr);
  const std::uint32_t first = ntohl(socket_address->sin_addr.s_addr);
  ::freeaddrinfo(found);
  return first;
}

}  // namespace

Endpoint ParseEndpoint(std::string_view text, std::uint16_t default_port) {
  constexpr std::string_view kLoopback = "127.0.0.1";
  const std::size_t colon = text.rfind(':');
  const std::string_view host = text.substr(0, colon);
  if (text.empty()) throw InputError("must be HOST:PORT, HOST or :PORT (got nothing)");
  Endpoint endpoint;
  endpoint.port =
      colon == std::string_view::npos ? default_port : ParsePort(text.substr(colon + 1), text);
  endpoint.address = ParseHost(std::string(host.empty() ? kLoopback : host), text);
  return endpoint;
}

std::string EndpointText(const Endpoint& endpoint) {
  std::string text;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) {
    text += std::to_string(endpoint.address >> shift & 0xFFU) + (shift > 0 ? "." : ":");
  }
  return text + std::to_string(endpoint.port);
}

}  // namespace railcast
