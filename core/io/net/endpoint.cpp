#include "railcast/io/endpoint.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>

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

/// The first address of a family that a name has, or nothing.
std::optional<IpAddress> Resolve(const std::string& host, int family) {
  addrinfo hints{};
  hints.ai_family = family;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0 || found == nullptr) return {};
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, ::freeaddrinfo);
  if (family == AF_INET) {
    const auto* address = reinterpret_cast<const sockaddr_in*>(found->ai_addr);
    return ntohl(address->sin_addr.s_addr);
  }
  IpAddress address;
  const auto* ipv6 = reinterpret_cast<const sockaddr_in6*>(found->ai_addr);
  std::copy_n(ipv6->sin6_addr.s6_addr, address.bytes.size(), address.bytes.begin());
  return address;
}

IpAddress ParseIpv4OrName(const std::string& host, std::string_view whole) {
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
  // IPv4 first, which the sensors' own programs understand.
  for (const int family : {AF_INET, AF_INET6}) {
    if (const auto found = Resolve(host, family)) return *found;
  }
  throw InputError(
      "must be HOST:PORT with an IPv4 address, an IPv6 address in brackets, or a known name (got " +
      std::string(whole) + ")");
}

IpAddress ParseIpv6(const std::string& host, std::string_view whole) {
  IpAddress address;
  if (::inet_pton(AF_INET6, host.c_str(), address.bytes.data()) == 1) return address;
  throw InputError("must be an IPv6 address, as [::1]:2368 or [fe80::1%eth0]:2368 (got " +
                   std::string(whole) + ")");
}

// Whether an address or a group is the same on every link (RFC 4291, 2.5.6 and 2.7), so that only
// an interface tells which one is meant.
bool NeedsInterface(const IpAddress& address) {
  const auto& bytes = address.bytes;
  const bool is_of_link = bytes[0] == 0xFE && (bytes[1] & 0xC0U) == 0x80U;
  const bool is_group_of_link = bytes[0] == 0xFF && (bytes[1] & 0x0FU) <= 2;
  return is_of_link || is_group_of_link;
}

/// @param name Behind the address's %; absent = there is none.
std::uint32_t ParseInterface(const std::optional<std::string>& name,
                             const IpAddress& address,
                             std::string_view whole) {
  const std::string got = " (got " + std::string(whole) + ")";
  if (!name) {
    if (!NeedsInterface(address)) return 0;
    throw InputError("must name the network interface, as [fe80::1%eth0]:2368 does" + got);
  }
  if (!NeedsInterface(address) && !address.is_multicast()) {
    throw InputError(
        "must name no network interface, which multicast groups and link-local addresses alone "
        "have" +
        got);
  }
  const unsigned interface = ::if_nametoindex(name->c_str());
  if (interface == 0) {
    throw InputError("must name a network interface of this machine behind %" + got);
  }
  return interface;
}

IpAddress ParseHost(std::string_view host, bool is_ipv6, std::string_view whole) {
  const std::size_t percent = host.find('%');
  const std::string plain(host.substr(0, percent));
  std::optional<std::string> name;
  if (percent != std::string_view::npos) name = host.substr(percent + 1);
  IpAddress address = is_ipv6 ? ParseIpv6(plain, whole) : ParseIpv4OrName(plain, whole);
  address.interface = ParseInterface(name, address, whole);
  return address;
}

}  // namespace

bool IpAddress::is_loopback() const {
  if (is_ipv4()) return bytes[12] == 127;
  return bytes.back() == 1 &&
         std::all_of(bytes.begin(), bytes.end() - 1, [](auto byte) { return byte == 0; });
}

bool IpAddress::is_multicast() const {
  return is_ipv4() ? (bytes[12] & 0xF0U) == 0xE0U : bytes[0] == 0xFF;
}

Endpoint ParseEndpoint(std::string_view text, std::uint16_t default_port) {
  constexpr std::string_view kLoopback = "127.0.0.1";
  if (text.empty()) throw InputError("must be HOST:PORT, HOST or :PORT (got nothing)");
  const bool has_brackets = text.starts_with('[');
  // Without brackets, several colons are those of an address alone.
  const bool is_ipv6 = has_brackets || std::count(text.begin(), text.end(), ':') > 1;
  std::string_view host = text;
  std::optional<std::string_view> port;
  const std::size_t colon = text.rfind(':');
  if (has_brackets) {
    host = text.substr(1, text.find(']') - 1);
    const std::string_view rest = text.substr(std::min(text.size(), host.size() + 2));
    if (rest.starts_with(':')) port = rest.substr(1);
    // What is between or behind the brackets and is no port makes no address.
    if (host.size() + 1 == text.size() || (!port && !rest.empty())) host = "";
  } else if (!is_ipv6 && colon != std::string_view::npos) {
    host = text.substr(0, colon);
    port = text.substr(colon + 1);
  }
  Endpoint endpoint;
  endpoint.port = port ? ParsePort(*port, text) : default_port;
  endpoint.address = ParseHost(host.empty() && !is_ipv6 ? kLoopback : host, is_ipv6, text);
  return endpoint;
}

std::string AddressText(const IpAddress& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.is_ipv4()) {
    ::inet_ntop(AF_INET, address.bytes.data() + 12, text.data(), text.size());
  } else {
    ::inet_ntop(AF_INET6, address.bytes.data(), text.data(), text.size());
  }
  if (address.interface == 0) return text.data();
  std::array<char, IF_NAMESIZE> name{};
  // An interface that no longer exists has no name, so that its number is shown.
  if (::if_indextoname(address.interface, name.data()) == nullptr) {
    return std::string(text.data()) + "%" + std::to_string(address.interface);
  }
  return std::string(text.data()) + "%" + name.data();
}

std::string EndpointText(const Endpoint& endpoint) {
  const std::string address = AddressText(endpoint.address);
  return (endpoint.address.is_ipv4() ? address : "[" + address + "]") + ":" +
         std::to_string(endpoint.port);
}

}  // namespace railcast
