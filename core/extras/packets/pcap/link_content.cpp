#include <algorithm>
#include <array>
#include <utility>

#include <pcap/pcap.h>

#include "core/extras/packets/pcap/pcap_reader.h"

namespace railcast {
namespace {

constexpr std::size_t kVlanTagSize = 4;

/// What begins with the version of IP.
LinkContent IpContent(std::span<const char> bytes) {
  if (bytes.empty()) return {.is_cut = true};
  const unsigned version = OctetAt(bytes, 0) >> 4U;
  if (version == 4) return {LinkContent::kIpv4Type, bytes};
  return {version == 6 ? LinkContent::kIpv6Type : std::uint16_t{}, bytes};
}

/// What follows the family's number, in whichever byte order.
LinkContent LoopbackContent(std::span<const char> frame) {
  constexpr std::size_t kFamilySize = 4;
  if (frame.size() <= kFamilySize) return {.is_cut = true};
  // IPv4 has the number 2 everywhere, IPv6 one of those of Linux, BSD, FreeBSD and macOS.
  constexpr auto kFamilies = std::to_array<unsigned>({2, 10, 24, 28, 30});
  const unsigned family = OctetAt(frame, 0) | OctetAt(frame, 3);
  if (std::ranges::count(kFamilies, family) > 0) return IpContent(frame.subspan(kFamilySize));
  return {static_cast<std::uint16_t>(family), frame.subspan(kFamilySize)};
}

/// Where the type of what a frame carries stands, and where that begins.
struct LinkHead {
  std::size_t type_place{};
  std::size_t size{};
};

/// What follows the header of Ethernet, or the one that Linux has in its place, and VLAN tags.
LinkContent TaggedContent(std::span<const char> frame, LinkHead head) {
  constexpr auto kTagTypes = std::to_array<std::uint16_t>({0x8100, 0x88A8, 0x9100});
  while (frame.size() >= std::max(head.size, head.type_place + 2)) {
    const std::uint16_t type = BigAt(frame, head.type_place);
    if (std::ranges::count(kTagTypes, type) == 0) return {type, frame.subspan(head.size)};
    head = {head.size + 2, head.size + kVlanTagSize};
  }
  return {.is_cut = true};
}

LinkContent EthernetContent(std::span<const char> frame) {
  return TaggedContent(frame, {kEthernetSize - 2, kEthernetSize});
}

LinkContent ContentOfLink(std::span<const char> frame, int link) {
  switch (link) {
    case DLT_NULL:
    case DLT_LOOP:
      return LoopbackContent(frame);
    case DLT_LINUX_SLL:
      return TaggedContent(frame, {14, 16});
    case DLT_LINUX_SLL2:
      return TaggedContent(frame, {0, 20});
    case DLT_EN10MB:
      return EthernetContent(frame);
    default:
      return IpContent(frame);
  }
}

constexpr std::uint16_t kEthernetType = 0x6558;  // Type of a frame within another packet.

LinkContent ContentOfType(std::uint16_t type, std::span<const char> bytes) {
  return type == kEthernetType ? EthernetContent(bytes) : LinkContent{type, bytes};
}

/// What follows a header of this size; nothing if that is not there.
std::span<const char> Behind(std::span<const char> bytes, std::size_t size) {
  return bytes.subspan(std::min(size, bytes.size()));
}

// Generic routing encapsulation (RFC 2784, 2890), also with the headers that switches add for
// mirrored ports, ERSPAN of type I to III (draft-foschiano-erspan-03).
LinkContent GreContent(std::span<const char> gre) {
  if (gre.size() < 4) return {.is_cut = true};
  constexpr std::uint16_t kErspan = 0x88BE;
  constexpr std::uint16_t kErspan3 = 0x22EB;
  const std::uint16_t flags = BigAt(gre, 0);
  const std::uint16_t type = BigAt(gre, 2);
  std::size_t size = 4;
  for (const unsigned field : {0x8000U, 0x2000U, 0x1000U}) {  // Checksum, key, number.
    size += (flags & field) != 0 ? 4 : 0;
  }
  if (type == kErspan) {
    const bool has_number = (flags & 0x1000U) != 0;
    return EthernetContent(Behind(gre, size + (has_number ? 8 : 0)));
  }
  if (type != kErspan3) return ContentOfType(type, Behind(gre, size));
  const auto header = Behind(gre, size);
  if (header.size() < 12) return {.is_cut = true};
  return EthernetContent(Behind(header, (OctetAt(header, 11) & 1U) != 0 ? 20 : 12));
}

// VXLAN (RFC 7348), also at the port that Linux has for it.
LinkContent VxlanContent(std::span<const char> vxlan) {
  constexpr unsigned kHasNetwork = 8;
  if (vxlan.size() < 8 || (OctetAt(vxlan, 0) & kHasNetwork) == 0) return {};
  return EthernetContent(vxlan.subspan(8));
}

// RFC 8926.
LinkContent GeneveContent(std::span<const char> geneve) {
  if (geneve.size() < 8 || OctetAt(geneve, 0) >> 6U != 0) return {};
  const std::size_t options = 4 * std::size_t{OctetAt(geneve, 0)};
  return ContentOfType(BigAt(geneve, 2), Behind(geneve, 8 + options));
}

// The user plane of mobile networks (3GPP TS 29.281, 5).
LinkContent GtpContent(std::span<const char> gtp) {
  constexpr unsigned kVersion1 = 0x30;
  constexpr unsigned kHasExtensions = 4;
  constexpr unsigned kUserData = 255;
  if (gtp.size() < 8) return {};
  const unsigned flags = OctetAt(gtp, 0);
  if ((flags & 0xF0U) != kVersion1 || OctetAt(gtp, 1) != kUserData) return {};
  std::size_t size = (flags & 7U) != 0 ? 12 : 8;
  // Each extension begins with its size and ends with the type of the next one.
  while ((flags & kHasExtensions) != 0 && size < gtp.size() && OctetAt(gtp, size - 1) != 0 &&
         OctetAt(gtp, size) != 0) {
    size += 4 * std::size_t{OctetAt(gtp, size)};
  }
  return IpContent(Behind(gtp, size));
}

// TZSP, as MikroTik's routers send: a header of 4 bytes, and fields up to the one of type 1.
LinkContent TzspContent(std::span<const char> tzsp) {
  if (tzsp.size() < 5 || OctetAt(tzsp, 0) != 1 || BigAt(tzsp, 2) != 1) return {};
  std::size_t size = 4;
  while (size + 1 < tzsp.size() && OctetAt(tzsp, size) != 1) {
    size += OctetAt(tzsp, size) == 0 ? 1 : 2 + std::size_t{OctetAt(tzsp, size + 1)};
  }
  return EthernetContent(Behind(tzsp, size + 1));
}

/// The protocol of what a packet of IP carries in one piece, and that, as far as it is there.
std::pair<std::uint8_t, std::span<const char>> CarriedBy(const LinkContent& ip) {
  if (ip.is_ipv6()) {
    const Ipv6Content content = ContentOfIpv6(ip.bytes);
    if (content.is_cut || content.fragment != 0) return {};
    return {content.protocol, Behind(ip.bytes, content.place)};
  }
  constexpr std::uint16_t kOffsetAndMore = 0x3FFF;
  if (!ip.is_ip() || ip.bytes.size() < kIpv4HeaderSize) return {};
  if ((BigAt(ip.bytes, 6) & kOffsetAndMore) != 0) return {};
  const std::size_t size = 4 * std::size_t{OctetAt(ip.bytes, 0) & 0xFU};
  return {OctetAt(ip.bytes, kUdpProtocolPlace), Behind(ip.bytes, size)};
}

/// What is in a packet that carries another one; nothing if it does not.
LinkContent TunnelledIn(const LinkContent& outer) {
  constexpr std::uint8_t kIpv4 = 4;
  constexpr std::uint8_t kIpv6 = 41;
  constexpr std::uint8_t kGre = 47;
  const auto& [protocol, bytes] = CarriedBy(outer);
  if (protocol == kIpv4 || protocol == kIpv6) return IpContent(bytes);
  if (protocol == kGre) return GreContent(bytes);
  if (protocol != kUdpProtocol || bytes.size() < kUdpHeaderSize) return {};
  const auto payload = bytes.subspan(kUdpHeaderSize);
  switch (BigAt(bytes, 2)) {  // The port that it goes to.
    case 4789:
    case 8472:
      return VxlanContent(payload);
    case 6081:
      return GeneveContent(payload);
    case 2152:
      return GtpContent(payload);
    case 37008:
      return TzspContent(payload);
    default:
      return {};
  }
}

/// The innermost of the packets that a frame carries, such as that of a mirrored port.
LinkContent Innermost(LinkContent content) {
  constexpr int kMostTunnels = 4;
  for (int i = 0; i < kMostTunnels && content.is_ip(); ++i) {
    const LinkContent inner = TunnelledIn(content);
    if (!inner.is_ip() && (inner.is_cut || inner.bytes.empty() || !inner.carries_no_udp())) break;
    content = inner;
  }
  return content;
}

}  // namespace

bool LinkContent::carries_no_udp() const {
  constexpr std::uint16_t kLeastType = 0x0600;
  constexpr auto kTypes = std::to_array<std::uint16_t>(
      {0x0806, 0x0842, 0x8035, 0x8809, 0x888E, 0x8899, 0x88CC, 0x88E1, 0x88F7, 0x8902, 0x9000});
  return type < kLeastType || std::ranges::count(kTypes, type) > 0;
}

LinkContent ContentOf(std::span<const char> frame, int link) {
  return Innermost(ContentOfLink(frame, link));
}

Ipv6Content ContentOfIpv6(std::span<const char> ip) {
  constexpr std::uint8_t kFragment = 44;
  constexpr auto kOptions =
      std::to_array<std::uint8_t>({0, 43, 60});  // Hop by hop, routing, destination.
  if (ip.size() < kIpv6HeaderSize) return {.is_cut = true};
  Ipv6Content content{.protocol = OctetAt(ip, 6), .place = kIpv6HeaderSize};
  while (content.protocol == kFragment ||
         std::ranges::find(kOptions, content.protocol) != kOptions.end()) {
    const bool is_fragment = content.protocol == kFragment;
    if (content.place + 8 > ip.size()) {
      content.is_cut = true;
      return content;
    }
    if (is_fragment) content.fragment = content.place;
    content.protocol = OctetAt(ip, content.place);
    content.place += is_fragment ? 8 : 8 * (std::size_t{1} + OctetAt(ip, content.place + 1));
    // What follows the fragment header of a fragment is a piece of the packet.
    constexpr std::uint16_t kOffsetAndMore = 0xFFF9;
    if (is_fragment && (BigAt(ip, content.fragment + 2) & kOffsetAndMore) != 0) break;
  }
  return content;
}

}  // namespace railcast
