#include "core/io/pcap/pcap_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <string>
#include <utility>

#include <pcap/pcap.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

constexpr std::size_t kMostUnfinished = 64;
constexpr std::size_t kMostBytes = 65535;

std::string SpanOf(std::size_t begin, std::size_t end) {
  return NumberText(begin) + " to " + NumberText(end);
}

constexpr std::size_t kVlanTagSize = 4;
constexpr std::size_t kMaxVlanTags = 2;

std::uint16_t BigAt(std::span<const char> bytes, std::size_t place) {
  return static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[place]) << 8U |
                                    static_cast<unsigned char>(bytes[place + 1]));
}

constexpr std::size_t kUdpProtocolPlace = 9;  // In the IPv4 header.

std::uint8_t OctetAt(std::span<const char> bytes, std::size_t place) {
  return static_cast<std::uint8_t>(bytes[place]);
}

/// What a frame carries.
struct IpPacket {
  bool is_ipv6{};
  std::span<const char> bytes;
};

// Returns what follows the Ethernet header and its VLAN tags if that is IPv4 or IPv6. The result is
// empty, too, if the frame ends before its protocol can be told.
std::optional<IpPacket> PacketIn(std::span<const char> frame) {
  std::size_t type_place = kEthernetSize - 2;
  for (std::size_t tags = 0; tags <= kMaxVlanTags; ++tags, type_place += kVlanTagSize) {
    if (frame.size() < type_place + 2) return IpPacket{};
    const std::uint16_t type = BigAt(frame, type_place);
    if (type == 0x0800 || type == 0x86DD)
      return IpPacket{type == 0x86DD, frame.subspan(type_place + 2)};
    if (type != 0x8100 && type != 0x88A8) return std::nullopt;
  }
  return std::nullopt;
}

/// What follows the headers of an IPv6 packet, as far as these are there.
struct Ipv6Content {
  std::uint8_t protocol{};
  std::size_t place{};
  bool is_cut{};           ///< The headers go on behind the end.
  std::size_t fragment{};  ///< Place of the fragment header; 0 = none.
};

// Walks over the extension headers that may stand before UDP (RFC 8200, 4).
Ipv6Content ContentOf(std::span<const char> ip) {
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

// Whether the captured part of a frame may be the beginning of a UDP datagram. Frames of other
// protocols are not wanted and may be truncated anywhere.
bool MayBeginDatagram(std::span<const char> frame) {
  const auto ip = PacketIn(frame);
  if (!ip) return false;
  if (ip->is_ipv6) {
    const Ipv6Content content = ContentOf(ip->bytes);
    return content.is_cut || content.protocol == kUdpProtocol;
  }
  if (ip->bytes.size() <= kUdpProtocolPlace) return true;
  return OctetAt(ip->bytes, 0) >> 4U == 4 && OctetAt(ip->bytes, kUdpProtocolPlace) == kUdpProtocol;
}

// Returns what an IPv4 packet carries for UDP: a datagram or a fragment of one.
std::optional<IpFragment> UdpFragment(std::span<const char> ip) {
  if (ip.size() < kIpv4HeaderSize) return std::nullopt;
  const std::uint8_t version_and_words = OctetAt(ip, 0);
  const std::size_t header_size = std::size_t{version_and_words & 0xFU} * 4;
  // The packet's own length counts, since Ethernet may pad the frame behind it.
  const std::size_t size = BigAt(ip, 2);
  if (version_and_words >> 4U != 4 || header_size < kIpv4HeaderSize || size < header_size ||
      size > ip.size() || OctetAt(ip, kUdpProtocolPlace) != kUdpProtocol) {
    return std::nullopt;
  }
  constexpr std::uint16_t kMoreFragments = 0x2000U;
  const std::uint16_t flags_and_offset = BigAt(ip, 6);
  IpFragment fragment{.source = IpAddress(std::uint32_t{BigAt(ip, 12)} << 16U | BigAt(ip, 14)),
                      .offset = (flags_and_offset & 0x1FFFU) * std::size_t{8},
                      .is_last = (flags_and_offset & kMoreFragments) == 0,
                      .bytes = ip.subspan(header_size, size - header_size)};
  const auto addresses = ip.subspan(12, 8);
  const auto identification = ip.subspan(4, 2);
  std::ranges::copy(identification, std::ranges::copy(addresses, fragment.packet.begin()).out);
  return fragment;
}

// As UdpFragment(), of an IPv6 packet.
std::optional<IpFragment> UdpFragmentOfIpv6(std::span<const char> ip) {
  if (ip.size() < kIpv6HeaderSize || OctetAt(ip, 0) >> 4U != 6) return std::nullopt;
  const std::size_t size = kIpv6HeaderSize + BigAt(ip, 4);
  if (size > ip.size()) return std::nullopt;
  ip = ip.first(size);
  const Ipv6Content content = ContentOf(ip);
  if (content.is_cut || content.protocol != kUdpProtocol || content.place > size) {
    return std::nullopt;
  }
  IpFragment fragment{.offset = 0, .is_last = true, .bytes = ip.subspan(content.place)};
  std::ranges::transform(ip.subspan(8, 16), fragment.source.bytes.begin(),
                         [](char octet) { return static_cast<std::uint8_t>(octet); });
  if (content.fragment == 0) return fragment;
  const std::uint16_t offset_and_flag = BigAt(ip, content.fragment + 2);
  fragment.offset = offset_and_flag & 0xFFF8U;
  fragment.is_last = (offset_and_flag & 1U) == 0;
  const auto addresses = ip.subspan(8, 32);
  const auto identification = ip.subspan(content.fragment + 4, 4);
  std::ranges::copy(identification, std::ranges::copy(addresses, fragment.packet.begin()).out);
  return fragment;
}

bool IsWhole(const IpFragment& fragment) {
  return fragment.offset == 0 && fragment.is_last;
}

std::optional<CapturedDatagram> DatagramIn(std::span<const char> udp) {
  if (udp.size() < kUdpHeaderSize) return std::nullopt;
  const std::size_t size = BigAt(udp, 4);
  if (size < kUdpHeaderSize || size > udp.size()) return std::nullopt;
  return CapturedDatagram{.payload = udp.subspan(kUdpHeaderSize, size - kUdpHeaderSize),
                          .source_port = BigAt(udp, 0),
                          .destination_port = BigAt(udp, 2)};
}

std::optional<IpFragment> FindFragment(std::span<const char> frame) {
  const auto ip = PacketIn(frame);
  if (!ip) return std::nullopt;
  return ip->is_ipv6 ? UdpFragmentOfIpv6(ip->bytes) : UdpFragment(ip->bytes);
}

// The time of capture, for which libpcap was asked in nanoseconds: tv_usec holds these.
std::int64_t TimeOf(pcap_t* pcap, const pcap_pkthdr& header, const std::string& place) {
  // Classic captures, whose version is 2, have unsigned seconds of 32 bits (IETF,
  // draft-ietf-opsawg-pcap, 5), which libpcap takes for signed ones.
  const bool is_classic = pcap_major_version(pcap) == 2;
  const std::int64_t time_s = is_classic
                                  ? std::int64_t{static_cast<std::uint32_t>(header.ts.tv_sec)}
                                  : std::int64_t{header.ts.tv_sec};
  // pcapng's clocks have more bits than int64_t has nanoseconds.
  constexpr std::int64_t kMaxTime_s = std::numeric_limits<std::int64_t>::max() / kNsPerS - 1;
  if (time_s < 0 || time_s > kMaxTime_s) {
    throw InputError(place + "must be captured before the year 2262 (got " + NumberText(time_s) +
                     " s since 1970)");
  }
  return time_s * kNsPerS + header.ts.tv_usec;
}

std::FILE* Open(const std::filesystem::path& file) {
  CheckIsReadable(file);
  std::FILE* const stream = std::fopen(file.c_str(), "rbe");
  if (stream == nullptr) throw FileError(file, errno);
  return stream;
}

}  // namespace

IpFragments::Packet& IpFragments::PacketOf(const IpFragment& fragment) {
  // Identifications are used again, on busy networks after some seconds.
  num_given_up_ += std::erase_if(unfinished_, [&](const Packet& packet) {
    return fragment.time_ns - packet.time_ns > kNsPerS;
  });
  const auto found = std::ranges::find(unfinished_, fragment.packet, &Packet::name);
  if (found != unfinished_.end()) return *found;
  if (unfinished_.size() == kMostUnfinished) {
    unfinished_.pop_front();
    ++num_given_up_;
  }
  return unfinished_.emplace_back(Packet{
      .name = fragment.packet, .time_ns = fragment.time_ns, .bytes = {}, .parts = {}, .end = {}});
}

std::optional<std::span<const char>> IpFragments::Add(const IpFragment& fragment) {
  const std::size_t begin = fragment.offset;
  const std::size_t end = begin + fragment.bytes.size();
  if (end > kMostBytes) {
    throw InputError("an IP fragment must end within 65535 bytes" + Got(end));
  }
  Packet& packet = PacketOf(fragment);
  const std::size_t last = packet.parts.empty() ? 0 : packet.parts.rbegin()->second.end;
  if ((packet.end && end > *packet.end) || (fragment.is_last && end < last)) {
    throw InputError("an IP fragment must lie before the end of its packet (got bytes " +
                     SpanOf(begin, end) + ", the end at " +
                     NumberText(packet.end ? *packet.end : end) + ")");
  }
  // The first part that ends behind this one's begin is the only one that may be the same.
  const auto after =
      std::ranges::find_if(packet.parts, [&](const auto& part) { return part.second.end > begin; });
  if (after != packet.parts.end() && after->first < end) {
    const bool is_same =
        after->first == begin && after->second.end == end &&
        std::ranges::equal(fragment.bytes,
                           std::span(packet.bytes).subspan(begin, fragment.bytes.size()));
    if (is_same) return std::nullopt;
    throw InputError("an IP fragment must not overlap another (got bytes " + SpanOf(begin, end) +
                     " beside " + SpanOf(after->first, after->second.end) + ")");
  }
  if (packet.bytes.size() < end) packet.bytes.resize(end);
  std::ranges::copy(fragment.bytes, packet.bytes.begin() + static_cast<std::ptrdiff_t>(begin));
  if (begin < end) packet.parts.emplace(begin, Part{end, fragment.place});
  if (fragment.is_last) packet.end = end;
  std::size_t reached = 0;
  for (const auto& [part_begin, part] : packet.parts) {
    if (part_begin == reached) reached = part.end;
  }
  if (packet.end != reached) return std::nullopt;
  pieces_.clear();
  for (const auto& [part_begin, part] : packet.parts) {
    pieces_.push_back({part.place, part.end - part_begin});
  }
  whole_ = std::move(packet.bytes);
  unfinished_.remove_if([&](const Packet& other) { return &other == &packet; });
  return whole_;
}

std::optional<CapturedDatagram> FindDatagram(std::span<const char> frame) {
  const auto fragment = FindFragment(frame);
  if (!fragment || !IsWhole(*fragment)) return std::nullopt;
  auto datagram = DatagramIn(fragment->bytes);
  if (datagram) datagram->source_address = fragment->source;
  return datagram;
}

struct PcapReader::Capture {
  pcap_t* pcap{};

  Capture() = default;
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;
  ~Capture() {
    if (pcap != nullptr) pcap_close(pcap);
  }
};

PcapReader::PcapReader(const std::filesystem::path& file)
    : PcapReader(Open(file), ShownPath(file)) {}

PcapReader::PcapReader(std::FILE* stream, std::string name)
    : name_(std::move(name)), capture_(std::make_unique<Capture>()) {
  std::array<char, PCAP_ERRBUF_SIZE> reason{};
  capture_->pcap =
      pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, reason.data());
  if (capture_->pcap == nullptr) {
    std::fclose(stream);
    throw InputError(name_ + ": " + reason.data());
  }
  const int link = pcap_datalink(capture_->pcap);
  if (link == DLT_EN10MB) return;
  const char* const link_name = pcap_datalink_val_to_name(link);
  throw InputError(name_ + ": must be a capture of Ethernet frames (got " +
                   (link_name != nullptr ? std::string(link_name) : NumberText(link)) + ")");
}

PcapReader::~PcapReader() = default;

std::uint64_t PcapReader::PlaceOf(std::span<const char> packet, const std::string& place) const {
  // Of classic captures a packet ends where libpcap stands, and so does its block in pcapng, whose
  // last four bytes are its length, and from whose begin on the packet is 28 bytes away, or 12 in a
  // simple packet block (IETF, draft-tuexen-opsawg-pcapng, 4.3 and 4.4).
  constexpr std::array<std::uint64_t, 2> kBlockHeads = {28, 12};
  std::FILE* const stream = pcap_file(capture_->pcap);
  const auto end = static_cast<std::uint64_t>(::ftello(stream));
  const int file = ::fileno(stream);
  std::vector<std::uint64_t> candidates = {end - packet.size()};
  std::uint32_t length = 0;
  if (::pread(file, &length, sizeof length, static_cast<::off_t>(end - sizeof length)) == 4) {
    for (const std::uint32_t size : {length, __builtin_bswap32(length)}) {
      for (const std::uint64_t head : kBlockHeads) candidates.push_back(end - size + head);
    }
  }
  std::vector<char> there(packet.size());
  for (const std::uint64_t candidate : candidates) {
    if (candidate > end || end - candidate < packet.size()) continue;
    const auto got = ::pread(file, there.data(), there.size(), static_cast<::off_t>(candidate));
    if (got >= 0 && static_cast<std::size_t>(got) == there.size() &&
        std::ranges::equal(there, packet)) {
      return candidate;
    }
  }
  throw InputError(place + "must stand in the file as it was captured (got a stream)");
}

std::optional<CapturedDatagram> PcapReader::Next() {
  while (true) {
    pcap_pkthdr* header = nullptr;
    const u_char* bytes = nullptr;
    const int status = pcap_next_ex(capture_->pcap, &header, &bytes);
    if (status == PCAP_ERROR_BREAK) return std::nullopt;
    const std::size_t packet = num_frames_++;
    const std::string place = name_ + ": packet " + NumberText(packet) + ": ";
    if (status != 1) throw InputError(place + pcap_geterr(capture_->pcap));
    const std::span<const char> kept(reinterpret_cast<const char*>(bytes), header->caplen);
    auto fragment = FindFragment(kept);
    const bool is_datagram = fragment && (!IsWhole(*fragment) || DatagramIn(fragment->bytes));
    if (!is_datagram && header->caplen < header->len && MayBeginDatagram(kept)) {
      throw InputError(place + "must be captured whole (got " + NumberText(header->caplen) +
                       " of " + NumberText(header->len) + " bytes)");
    }
    if (!is_datagram) continue;
    const std::int64_t time_ns = TimeOf(capture_->pcap, *header, place);
    if (finds_places_) {
      const auto in_packet = static_cast<std::uint64_t>(fragment->bytes.data() - kept.data());
      fragment->place = PlaceOf(kept, place) + in_packet;
      pieces_ = {{fragment->place, fragment->bytes.size()}};
    }
    auto datagram =
        IsWhole(*fragment) ? DatagramIn(fragment->bytes) : PutTogether(*fragment, time_ns, place);
    if (!datagram) continue;
    datagram->source_address = fragment->source;
    datagram->packet = packet;
    datagram->time_ns = time_ns;
    if (finds_places_) datagram->pieces = IsWhole(*fragment) ? pieces_ : fragments_.pieces();
    return datagram;
  }
}

std::optional<CapturedDatagram> PcapReader::PutTogether(IpFragment fragment,
                                                        std::int64_t time_ns,
                                                        const std::string& place) {
  fragment.time_ns = time_ns;
  try {
    const auto udp = fragments_.Add(fragment);
    return udp ? DatagramIn(*udp) : std::nullopt;
  } catch (const InputError& error) {
    throw InputError(place + error.what());
  }
}

}  // namespace railcast
