#include "core/extras/dds/domain_config.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <memory>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast::dds {
namespace {

// How many participants a loopback domain may have, less one; each costs a datagram to find out
// whether it is there. ROS 2 allows as many.
constexpr const char* kLastIndex = "32";

// No multicast, and datagrams of the largest size: on loopback nothing cuts them up.
constexpr const char* kLoopbackGeneral =
    "<AllowMulticast>false</AllowMulticast><MaxMessageSize>65500B</MaxMessageSize>"
    "<FragmentSize>65000B</FragmentSize>";

/// Bursts for which a buffer of 208 KiB has room: the kernel counts small datagrams for more than
/// they hold.
std::string BurstsOf(const InterfaceAddress& interface) {
  return "<BurstSize><MaxInitTransmit>0</MaxInitTransmit><MaxRexmit>" +
         std::string(interface.is_loopback ? "130kB" : "100kB") + "</MaxRexmit></BurstSize>";
}

std::string Known(const std::vector<InterfaceAddress>& addresses) {
  std::string text;
  for (const InterfaceAddress& each : addresses) {
    text += (text.empty() ? "" : ", ") + each.name + " (" + each.address + ")";
  }
  return text;
}

const InterfaceAddress& Find(const std::string& interface,
                             const std::vector<InterfaceAddress>& addresses) {
  const auto found = std::find_if(addresses.begin(), addresses.end(), [&](const auto& each) {
    return interface.empty() ? each.is_loopback
                             : interface == each.name || interface == each.address;
  });
  if (found != addresses.end()) return *found;
  throw InputError("interface: must be the name or an address of a network interface that is up, " +
                   (addresses.empty() ? "of which there is none" : "one of " + Known(addresses)) +
                   " (got " +
                   (interface.empty() ? "loopback" : "\"" + ShownText(interface) + "\"") + ")");
}

/// By multicast, participants find each other wherever they are. Loopback has none, so that each
/// asks the ports of all others that there may be.
std::string DiscoveryOf(const InterfaceAddress& interface) {
  if (!interface.is_loopback) return "";
  const std::string peer = interface.is_ipv6() ? "[" + interface.address + "]" : interface.address;
  return "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>" +
         std::string(kLastIndex) + "</MaxAutoParticipantIndex><Peers><Peer Address=\"" + peer +
         "\"/></Peers></Discovery>";
}

/// The address as text; empty if it is of no family that DDS uses here. Link-local addresses of
/// IPv6, which mean nothing without their interface, are left out.
std::string TextOf(const sockaddr& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.sa_family == AF_INET) {
    const auto& ipv4 = reinterpret_cast<const sockaddr_in&>(address);
    ::inet_ntop(AF_INET, &ipv4.sin_addr, text.data(), text.size());
  } else if (address.sa_family == AF_INET6) {
    const auto& ipv6 = reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
    if (!IN6_IS_ADDR_LINKLOCAL(&ipv6)) {
      ::inet_ntop(AF_INET6, &ipv6, text.data(), text.size());
    }
  }
  return text.data();
}

}  // namespace

std::vector<InterfaceAddress> InterfaceAddresses() {
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> all(first, ::freeifaddrs);
  std::vector<InterfaceAddress> addresses;
  for (const ifaddrs* each = first; each != nullptr; each = each->ifa_next) {
    const bool is_up = (each->ifa_flags & IFF_UP) != 0;
    const std::string text = is_up && each->ifa_addr != nullptr ? TextOf(*each->ifa_addr) : "";
    if (text.empty()) continue;
    addresses.push_back({each->ifa_name, text, (each->ifa_flags & IFF_LOOPBACK) != 0});
  }
  // A name is that of its address of IPv4, if it has one.
  std::ranges::stable_partition(addresses, [](const auto& each) { return !each.is_ipv6(); });
  return addresses;
}

std::string DomainConfig(const ParticipantSpec& spec,
                         const std::vector<InterfaceAddress>& addresses) {
  const InterfaceAddress& interface = Find(spec.interface, addresses);
  std::string config =
      "<General><Interfaces><NetworkInterface address=\"" + interface.address + "\"/></Interfaces>";
  if (interface.is_ipv6()) config += "<Transport>udp6</Transport>";
  if (interface.is_loopback) config += kLoopbackGeneral;
  config += "</General>" + DiscoveryOf(interface) + "<Internal>";
  // The end of a run does not wait for readers that are slow or gone: WaitForReaders() does.
  config += "<WriterLingerDuration>0 s</WriterLingerDuration>";
  if (!spec.has_large_buffers) config += BurstsOf(interface);
  return config + "</Internal>";
}

}  // namespace railcast::dds
