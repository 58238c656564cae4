#include "core/extras/packets/pcap/pcap_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include <pcap/pcap.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/packets/pcap/internet_checksum.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

bool IsKnownLink(int link) {
  // libpcap's number for 101, IP of either version, is 12, or 14 on some systems.
  constexpr auto kLinks = std::to_array<int>({DLT_NULL, DLT_EN10MB, DLT_RAW, 12, 14, 101, DLT_LOOP,
                                              DLT_LINUX_SLL, DLT_IPV4, DLT_IPV6, DLT_LINUX_SLL2});
  return std::ranges::count(kLinks, link) > 0;
}

// Whether the captured part of a frame may be the beginning of a UDP datagram. Frames of other
// protocols are not wanted and may be truncated anywhere.
bool MayBeginDatagram(const LinkContent& ip) {
  if (ip.is_cut) return true;
  if (!ip.is_ip()) return false;
  if (ip.is_ipv6()) {
    const Ipv6Content content = ContentOfIpv6(ip.bytes);
    return content.is_cut || content.protocol == kUdpProtocol;
  }
  if (ip.bytes.size() <= kUdpProtocolPlace) return true;
  return OctetAt(ip.bytes, 0) >> 4U == 4 && OctetAt(ip.bytes, kUdpProtocolPlace) == kUdpProtocol;
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
                      .destination = IpAddress(std::uint32_t{BigAt(ip, 16)} << 16U | BigAt(ip, 18)),
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
  const Ipv6Content content = ContentOfIpv6(ip);
  if (content.is_cut || content.protocol != kUdpProtocol || content.place > size) {
    return std::nullopt;
  }
  IpFragment fragment{.offset = 0, .is_last = true, .bytes = ip.subspan(content.place)};
  const auto to_octet = [](char octet) { return static_cast<std::uint8_t>(octet); };
  std::ranges::transform(ip.subspan(8, 16), fragment.source.bytes.begin(), to_octet);
  std::ranges::transform(ip.subspan(24, 16), fragment.destination.bytes.begin(), to_octet);
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

/// Whether a datagram agrees with its checksum, or has none (RFC 768; RFC 8200, 8.1).
bool AgreesWithChecksum(const CapturedDatagram& datagram) {
  const std::span udp(datagram.payload.data() - kUdpHeaderSize,
                      datagram.payload.size() + kUdpHeaderSize);
  if (BigAt(udp, kUdpChecksumPlace) == 0) return true;
  // What addresses of IPv4 have before them adds nothing.
  std::uint64_t sum = AddWords(udp, udp.size() + kUdpProtocol);
  for (const IpAddress& address : {datagram.source_address, datagram.destination_address}) {
    sum =
        AddWords({reinterpret_cast<const char*>(address.bytes.data()), address.bytes.size()}, sum);
  }
  return ChecksumOf(sum) == 0;
}

/// "0x88A8"
std::string TypeText(std::uint16_t type) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "0x%04X", type);
  return text.data();
}

std::optional<IpFragment> FindFragment(const LinkContent& ip) {
  if (!ip.is_ip()) return std::nullopt;
  return ip.is_ipv6() ? UdpFragmentOfIpv6(ip.bytes) : UdpFragment(ip.bytes);
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

}  // namespace

std::optional<CapturedDatagram> FindDatagram(std::span<const char> frame) {
  const auto fragment = FindFragment(ContentOf(frame, DLT_EN10MB));
  if (!fragment || !IsWhole(*fragment)) return std::nullopt;
  auto datagram = DatagramIn(fragment->bytes);
  if (datagram) datagram->source_address = fragment->source;
  return datagram;
}

std::FILE* OpenStream(const std::filesystem::path& file) {
  CheckIsReadable(file);
  std::FILE* const stream = std::fopen(file.c_str(), "rbe");
  if (stream == nullptr) throw FileError(file, errno);
  return stream;
}

void PcapReader::Close::operator()(pcap* capture) const {
  pcap_close(capture);
}

PcapReader::PcapReader(const std::filesystem::path& file)
    : PcapReader(OpenStream(file), ShownPath(file)) {}

PcapReader::PcapReader(std::FILE* stream, std::string name) : name_(std::move(name)) {
  std::array<char, PCAP_ERRBUF_SIZE> reason{};
  capture_.reset(
      pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, reason.data()));
  if (!capture_) {
    std::fclose(stream);
    throw InputError(name_ + ": " + reason.data());
  }
  const int link = pcap_datalink(capture_.get());
  if (IsKnownLink(link)) return;
  const char* const link_name = pcap_datalink_val_to_name(link);
  throw InputError(name_ +
                   ": must be a capture of Ethernet, of Linux's \"any\" (SLL, SLL2), of a " +
                   "loopback device or of IP (got " +
                   (link_name != nullptr ? std::string(link_name) : NumberText(link)) + ")");
}

std::uint64_t PcapReader::PlaceOf(std::span<const char> packet, const std::string& place) const {
  // In classic captures a packet ends where libpcap stands, and so does its block in pcapng, whose
  // last four bytes are its length, and from whose begin on the packet is 28 bytes away, or 12 in a
  // simple packet block (IETF, draft-tuexen-opsawg-pcapng, 4.3 and 4.4).
  constexpr std::array<std::uint64_t, 2> kBlockHeads = {28, 12};
  std::FILE* const stream = pcap_file(capture_.get());
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
    const int status = pcap_next_ex(capture_.get(), &header, &bytes);
    if (status == PCAP_ERROR_BREAK) return std::nullopt;
    const std::size_t packet = num_frames_++;
    const std::string place = name_ + ": packet " + NumberText(packet) + ": ";
    if (status != 1) {
      const std::string reason = pcap_geterr(capture_.get());
      // libpcap says so, too, where the file begins no packet that could be one.
      if (!reason.starts_with("truncated") || std::feof(pcap_file(capture_.get())) == 0) {
        throw InputError(place + reason);
      }
      cut_ = {.number = 1, .first = packet};
      return std::nullopt;
    }
    const std::span<const char> kept(reinterpret_cast<const char*>(bytes), header->caplen);
    const LinkContent content = ContentOf(kept, pcap_datalink(capture_.get()));
    auto fragment = FindFragment(content);
    const bool is_datagram = fragment && (!IsWhole(*fragment) || DatagramIn(fragment->bytes));
    if (!is_datagram && header->caplen < header->len && MayBeginDatagram(content)) {
      throw InputError(place + "must be captured whole (got " + NumberText(header->caplen) +
                       " of " + NumberText(header->len) + " bytes)");
    }
    if (!is_datagram) {
      const bool is_unknown = content.is_ip() ? MayBeginDatagram(content)
                                              : !content.is_cut && !content.carries_no_udp();
      if (is_unknown && unknown_.number++ == 0) {
        unknown_.first = packet;
        unknown_.detail = content.is_ip() ? "a length of IP or UDP that the frame does not have"
                                          : "type " + TypeText(content.type);
      }
      continue;
    }
    fragment->number = packet;
    const std::int64_t time_ns = TimeOf(capture_.get(), *header, place);
    if (finds_places_) {
      const auto in_packet = static_cast<std::uint64_t>(fragment->bytes.data() - kept.data());
      fragment->place = PlaceOf(kept, place) + in_packet;
      pieces_ = {{fragment->place, fragment->bytes.size()}};
    }
    auto datagram =
        IsWhole(*fragment) ? DatagramIn(fragment->bytes) : PutTogether(*fragment, time_ns, place);
    if (!datagram) continue;
    datagram->source_address = fragment->source;
    datagram->destination_address = fragment->destination;
    datagram->packet = packet;
    datagram->time_ns = time_ns;
    datagram->has_wrong_checksum = !AgreesWithChecksum(*datagram);
    if (finds_places_) datagram->pieces = IsWhole(*fragment) ? pieces_ : fragments_.pieces();
    return datagram;
  }
}

std::vector<Remark> PcapReader::remarks() const {
  std::vector<Remark> remarks;
  const auto add = [&](RemarkKind kind, const LeftOut& left_out) {
    AddRemark({.kind = kind,
               .place = name_ + ": packet " + NumberText(left_out.first),
               .number = left_out.number,
               .detail = left_out.detail},
              remarks);
  };
  if (num_torn() > 0) add(RemarkKind::kFragmentsMissing, {num_torn(), fragments_.first_torn(), ""});
  add(RemarkKind::kFramesUnknown, unknown_);
  add(RemarkKind::kRecordingCut, cut_);
  return remarks;
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
