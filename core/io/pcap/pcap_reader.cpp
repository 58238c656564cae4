#include "core/io/pcap/pcap_reader.h"

#include <pcap/pcap.h>

#include <array>
#include <cerrno>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

constexpr std::size_t kEthernetSize = 14;
constexpr std::size_t kVlanTagSize = 4;
constexpr std::size_t kMaxVlanTags = 2;
constexpr std::size_t kUdpHeaderSize = 8;

std::uint16_t BigAt(std::span<const char> bytes, std::size_t place) {
  return static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[place]) << 8U |
                                    static_cast<unsigned char>(bytes[place + 1]));
}

constexpr std::size_t kUdpProtocolPlace = 9;  // In the IPv4 header.
constexpr char kUdpProtocol = 17;

// Returns what follows the Ethernet header and its VLAN tags if that is IPv4. The result is empty,
// too, if the frame ends before its protocol can be told.
std::optional<std::span<const char>> IpPacket(std::span<const char> frame) {
  std::size_t type_place = kEthernetSize - 2;
  for (std::size_t tags = 0; tags <= kMaxVlanTags; ++tags, type_place += kVlanTagSize) {
    if (frame.size() < type_place + 2) return frame.subspan(frame.size());
    const std::uint16_t type = BigAt(frame, type_place);
    if (type == 0x0800) return frame.subspan(type_place + 2);
    if (type != 0x8100 && type != 0x88A8) return std::nullopt;
  }
  return std::nullopt;
}

// Whether the captured part of a frame may be the beginning of a UDP datagram. Frames of other
// protocols are not wanted and may be truncated anywhere.
bool MayBeginDatagram(std::span<const char> frame) {
  const auto ip = IpPacket(frame);
  if (!ip) return false;
  if (ip->size() <= kUdpProtocolPlace) return true;
  return static_cast<unsigned char>((*ip)[0]) >> 4U == 4 &&
         (*ip)[kUdpProtocolPlace] == kUdpProtocol;
}

// Returns what follows the IPv4 header and its options if that is a whole UDP datagram.
std::optional<std::span<const char>> UdpPacket(std::span<const char> ip) {
  if (ip.size() < 20) return std::nullopt;
  const auto version_and_words = static_cast<unsigned char>(ip[0]);
  const std::size_t header_size = std::size_t{version_and_words & 0xFU} * 4;
  // The packet's own length counts, since Ethernet may pad the frame behind it.
  const std::size_t size = BigAt(ip, 2);
  const bool is_fragment = (BigAt(ip, 6) & 0x3FFFU) != 0;
  if (version_and_words >> 4U != 4 || header_size < 20 || size < header_size + kUdpHeaderSize ||
      size > ip.size() || is_fragment || ip[kUdpProtocolPlace] != kUdpProtocol) {
    return std::nullopt;
  }
  return ip.subspan(header_size, size - header_size);
}

}  // namespace

std::optional<CapturedDatagram> FindDatagram(std::span<const char> frame) {
  const auto ip = IpPacket(frame);
  const auto udp = ip ? UdpPacket(*ip) : std::nullopt;
  if (!udp) return std::nullopt;
  const std::size_t size = BigAt(*udp, 4);
  if (size < kUdpHeaderSize || size > udp->size()) return std::nullopt;
  return CapturedDatagram{.payload = udp->subspan(kUdpHeaderSize, size - kUdpHeaderSize),
                          .source_port = BigAt(*udp, 0),
                          .destination_port = BigAt(*udp, 2)};
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

namespace {

std::FILE* Open(const std::filesystem::path& file) {
  CheckIsReadable(file);
  std::FILE* const stream = std::fopen(file.c_str(), "rbe");
  if (stream == nullptr) throw FileError(file, errno);
  return stream;
}

}  // namespace

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
    auto datagram = FindDatagram(kept);
    if (!datagram && header->caplen < header->len && MayBeginDatagram(kept)) {
      throw InputError(place + "must be captured whole (got " + NumberText(header->caplen) +
                       " of " + NumberText(header->len) + " bytes)");
    }
    if (!datagram) continue;
    // pcapng's clocks have more bits than int64_t has nanoseconds.
    constexpr std::int64_t kMaxTime_s = std::numeric_limits<std::int64_t>::max() / kNsPerS - 1;
    if (header->ts.tv_sec < 0 || header->ts.tv_sec > kMaxTime_s) {
      throw InputError(place + "must be captured before the year 2262 (got " +
                       NumberText(header->ts.tv_sec) + " s since 1970)");
    }
    datagram->packet = packet;
    // libpcap was asked for nanosecond precision, so tv_usec holds nanoseconds.
    datagram->time_ns = header->ts.tv_sec * kNsPerS + header->ts.tv_usec;
    return datagram;
  }
}

}  // namespace railcast
