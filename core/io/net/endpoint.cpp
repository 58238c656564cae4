#include "railcast/io/stream.h"

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

// Whether the last label of a host name is a number, decimal or hexadecimal as in C. No host name
// ends so (RFC 1123, 2.1), but older resolver functions take such a name for an address, and read
// 010 as 8.
bool IsNumeric(std::string_view host) {
  if (host.ends_with('.')) host.remove_suffix(1);
  std::string_view last = host.substr(host.rfind('.') + 1);
  const bool is_hexadecimal = last.starts_with("0x") || last.starts_with("0X");
  if (is_hexadecimal) last.remove_prefix(2);
  constexpr std::string_view kDigits = "0123456789abcdefABCDEF";
  return (is_hexadecimal || !last.empty()) &&
         last.find_first_not_of(is_hexadecimal ? kDigits : kDigits.substr(0, 10)) ==
             std::string_view::npos;
}

std::uint32_t ParseHost(const std::string& host, std::string_view whole) {
  // Resolved here because a minimal system may have no /etc/hosts entry for it (RFC 6761, 6.3).
  if (host == "localhost") return INADDR_LOOPBACK;
  in_addr address{};
  if (::inet_pton(AF_INET, host.c_str(), &address) == 1) return ntohl(address.s_addr);
  if (IsNumeric(host)) {
    throw InputError(
        "a numeric address must be four numbers from 0 to 255 with dots between, none with a "
        "leading 0 (got " +
        std::string(whole) + ")");
  }
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
