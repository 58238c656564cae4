#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "railcast/io/endpoint.h"
#include "railcast/remark.h"

struct pcap;

namespace railcast {

inline constexpr std::size_t kEthernetSize = 14;
inline constexpr std::size_t kIpv4HeaderSize = 20;  ///< Without options.
inline constexpr std::size_t kIpv6HeaderSize = 40;  ///< Without extension headers.
inline constexpr std::size_t kUdpHeaderSize = 8;

/// Place of the checksum in UDP's header, in network byte order.
inline constexpr std::size_t kUdpChecksumPlace = 6;

inline constexpr std::uint8_t kUdpProtocol = 17;     ///< In the headers of IPv4 and IPv6.
inline constexpr std::size_t kUdpProtocolPlace = 9;  ///< In the IPv4 header.

/// A number in network byte order.
[[nodiscard]] inline std::uint16_t BigAt(std::span<const char> bytes, std::size_t place) {
  return static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[place]) << 8U |
                                    static_cast<unsigned char>(bytes[place + 1]));
}

[[nodiscard]] inline std::uint8_t OctetAt(std::span<const char> bytes, std::size_t place) {
  return static_cast<std::uint8_t>(bytes[place]);
}

/// What a frame carries: a packet of IP if the type is that.
struct LinkContent {
  static constexpr std::uint16_t kIpv4Type = 0x0800;  ///< Type in Ethernet.
  static constexpr std::uint16_t kIpv6Type = 0x86DD;

  std::uint16_t type{};  ///< As of Ethernet; of loopback devices the family, if it is not IP.
  std::span<const char> bytes{};
  bool is_cut{};  ///< The frame ends before its protocol can be told.

  [[nodiscard]] bool is_ipv6() const { return type == kIpv6Type; }
  [[nodiscard]] bool is_ip() const { return type == kIpv4Type || is_ipv6(); }
  /// Whether frames of the type are known to carry no UDP: those with a length in its place, ARP,
  /// time and what switches and network cards say to each other.
  [[nodiscard]] bool carries_no_udp() const;
};

/// What a captured frame carries, and of packets that carry others, as those of mirrored ports do,
/// the innermost.
/// @param link libpcap's number of a link type that PcapReader reads.
[[nodiscard]] LinkContent ContentOf(std::span<const char> frame, int link);

/// What follows the headers of an IPv6 packet, as far as these are there.
struct Ipv6Content {
  std::uint8_t protocol{};
  std::size_t place{};
  bool is_cut{};           ///< The headers go on behind the end.
  std::size_t fragment{};  ///< Place of the fragment header; 0 = none.
};

/// Walks over the extension headers that may stand before UDP (RFC 8200, 4).
[[nodiscard]] Ipv6Content ContentOfIpv6(std::span<const char> ip);

/// Where a piece of a datagram stands in the file that it was captured to.
struct CapturedPiece {
  std::uint64_t place{};  ///< Place of its first byte.
  std::size_t size{};
};

/// A piece of what a packet of IPv4 or IPv6 carries.
struct IpFragment {
  /// Source, destination and identification, as they were sent; those of IPv4 fill the first 10.
  std::array<char, 36> packet{};
  IpAddress source{};
  IpAddress destination{};
  std::size_t number{};  ///< Index among all packets of the file.
  std::size_t offset{};  ///< Place of its bytes in the packet's data.
  bool is_last{};        ///< Whether the data end with it.
  std::span<const char> bytes;
  std::int64_t time_ns{};  ///< Time of capture.
  std::uint64_t place{};   ///< Place of its bytes in the file, if that is wanted.
};

/// Puts together what was sent in fragments (RFC 791, 3.2; RFC 8200, 4.5), in whatever order these
/// were captured.
///
/// Fragments that a capture holds twice count once. Where some of those of a packet that was put
/// together follow within a second of its first one, nothing is missing. Any other packet of which
/// a fragment is missing is lost: it is given up when a fragment follows that was captured more
/// than a second after its first one, or when 64 newer ones are unfinished.
class IpFragments {
 public:
  /// Takes a fragment.
  /// @returns The packet's data if this completes them, valid until the next call.
  /// @throws InputError "rule (got value)" if the fragment overlaps one that differs from it, if it
  ///   lies behind the end of the packet, or if the packet would have more than 65,535 bytes.
  [[nodiscard]] std::optional<std::span<const char>> Add(const IpFragment& fragment);
  /// Where the packet that Add() returned last stands, piece by piece.
  [[nodiscard]] const std::vector<CapturedPiece>& pieces() const { return pieces_; }

  /// Number of packets that are unfinished or were given up.
  [[nodiscard]] std::size_t num_torn() const;
  /// IpFragment::number of the first fragment of the first of these.
  /// @pre num_torn() > 0
  [[nodiscard]] std::size_t first_torn() const;

 private:
  struct Part {
    std::size_t end{};
    std::uint64_t place{};  ///< In the file.
  };
  struct Packet {
    std::array<char, 36> name{};
    std::int64_t time_ns{};
    std::size_t number{};
    std::vector<char> bytes;
    std::map<std::size_t, Part> parts;  ///< By begin.
    std::optional<std::size_t> end;     ///< Known once the last fragment is there.
    bool is_copy{};  ///< Whether it repeats a finished one, as far as it is there.
  };

  Packet& PacketOf(const IpFragment& fragment);
  void GiveUp(const Packet& packet);
  /// Whether the fragment is that of a packet that was put together.
  [[nodiscard]] bool IsOfFinished(const IpFragment& fragment) const;

  std::list<Packet> unfinished_;  ///< From the oldest on.
  std::list<Packet> finished_;    ///< The last ones.
  std::vector<CapturedPiece> pieces_;
  std::size_t num_given_up_{};
  std::size_t first_given_up_{};
};

/// A captured UDP datagram, or several merged into one, all of the same size except that the last
/// may be smaller. Under UDP segmentation offload the network card or the loopback device cuts
/// apart what was sent in one call, so a capture on the sending machine sees it uncut. Only a
/// decoder of the protocol can tell where to cut.
struct CapturedDatagram {
  std::span<const char> payload;  ///< Valid until the next datagram is read.
  IpAddress source_address{};
  IpAddress destination_address{};
  std::uint16_t source_port{};
  std::uint16_t destination_port{};
  /// Time of capture since 1970-01-01 00:00:00 UTC; of a datagram in fragments, the last one's.
  std::int64_t time_ns{};
  std::size_t packet{};  ///< Index among all packets of the file, from 0; as `time_ns`.
  /// Whether it does not agree with its checksum. On the machine that sends them hardly any do
  /// where the network card fills that in.
  bool has_wrong_checksum{};
  /// Where the datagram stands in the file from its UDP header on, if PcapReader was asked for it.
  /// Valid as the payload.
  std::span<const CapturedPiece> pieces{};
};

/// Returns the UDP datagram in an Ethernet frame: IPv4 with any options or IPv6 with its extension
/// headers, behind any VLAN tags. Returns nothing if the frame holds none, or only a fragment
/// of one.
[[nodiscard]] std::optional<CapturedDatagram> FindDatagram(std::span<const char> frame);

/// Opens a file for a PcapReader.
/// @throws InputError as OpenInput() does.
[[nodiscard]] std::FILE* OpenStream(const std::filesystem::path& file);

/// Reads the UDP datagrams of a capture file, classic pcap or pcapng. Those sent in IP fragments
/// are put together (IpFragments); those of which fragments are missing are left out.
///
/// Packets are frames of Ethernet, what Linux captures on several interfaces at once (`-i any`, SLL
/// and SLL2), those of loopback devices, or IP alone. Those that carry others in VXLAN, Geneve, GRE
/// (with ERSPAN, too), GTP, TZSP or IP, as mirrored ports do, are taken for what they carry. A
/// capture that ends within a packet, as one whose program was killed, is read up to that.
class PcapReader {
 public:
  /// @throws InputError "file: reason" if the file is not a capture of such packets.
  explicit PcapReader(const std::filesystem::path& file);
  /// @param stream Owned by the reader from here on, and closed even if this throws.
  /// @param name Names the stream in error messages.
  PcapReader(std::FILE* stream, std::string name);
  /// Lets Next() say where datagrams stand in the file, which must be a regular one.
  void FindPlaces() { finds_places_ = true; }
  PcapReader(const PcapReader&) = delete;
  PcapReader& operator=(const PcapReader&) = delete;

  /// Returns the next datagram, whatever its port, or nothing at the end of the file.
  /// @throws InputError "file: packet 7: reason" where the file is damaged, the capture kept only
  ///   the beginning of a datagram, or IP fragments contradict each other.
  [[nodiscard]] std::optional<CapturedDatagram> Next();

  /// Number of datagrams so far of which not all IP fragments were found.
  [[nodiscard]] std::size_t num_torn() const { return fragments_.num_torn(); }
  /// What was left out so far, but for packets of IP that carry no UDP.
  [[nodiscard]] std::vector<Remark> remarks() const;

 private:
  struct Close {
    void operator()(pcap* capture) const;
  };
  /// The packets of a kind that were left out.
  struct LeftOut {
    std::size_t number{};
    std::size_t first{};
    std::string detail{};
  };

  [[nodiscard]] std::optional<CapturedDatagram> PutTogether(IpFragment fragment,
                                                            std::int64_t time_ns,
                                                            const std::string& place);

  /// Where the last packet's bytes stand in the file.
  /// @throws InputError if they are not found.
  [[nodiscard]] std::uint64_t PlaceOf(std::span<const char> packet, const std::string& place) const;

  IpFragments fragments_;
  std::vector<CapturedPiece> pieces_;  ///< Pieces of the last datagram.
  bool finds_places_ = false;
  std::string name_;
  std::size_t num_frames_{};
  LeftOut unknown_;
  LeftOut cut_;
  std::unique_ptr<pcap, Close> capture_;
};

}  // namespace railcast
