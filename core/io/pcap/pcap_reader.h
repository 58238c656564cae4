#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/io/pcap/ip_fragments.h"

namespace railcast {

/// A captured UDP datagram, or several merged into one, all of the same size except that the last
/// may be smaller. Under UDP segmentation offload the network card or the loopback device cuts
/// apart what was sent in one call, so a capture on the sending machine sees it uncut. Only a
/// decoder of the protocol can tell where to cut.
struct CapturedDatagram {
  std::span<const char> payload;  ///< Valid until the next datagram is read.
  std::uint16_t source_port{};
  std::uint16_t destination_port{};
  /// Time of capture since 1970-01-01 00:00:00 UTC; of a datagram in fragments, the last one's.
  std::int64_t time_ns{};
  std::size_t packet{};  ///< Index among all packets of the file, from 0; as `time_ns`.
};

/// Returns the UDP datagram in an Ethernet frame: IPv4 with any options, behind up to two VLAN
/// tags. Returns nothing if the frame holds none, or only a fragment of one.
[[nodiscard]] std::optional<CapturedDatagram> FindDatagram(std::span<const char> frame);

/// Reads the UDP datagrams of a capture file, classic pcap or pcapng. Those sent in IP fragments
/// are put together (IpFragments); those of which fragments are missing are left out.
class PcapReader {
 public:
  /// @throws InputError "file: reason" if the file is not a capture of Ethernet frames.
  explicit PcapReader(const std::filesystem::path& file);
  /// @param stream Owned by the reader from here on, and closed even if this throws.
  /// @param name Names the stream in error messages.
  PcapReader(std::FILE* stream, std::string name);
  ~PcapReader();
  PcapReader(const PcapReader&) = delete;
  PcapReader& operator=(const PcapReader&) = delete;

  /// Returns the next datagram, whatever its port, or nothing at the end of the file.
  /// @throws InputError "file: packet 7: reason" where the file is damaged, the capture kept only
  ///   the beginning of a datagram, or IP fragments contradict each other.
  [[nodiscard]] std::optional<CapturedDatagram> Next();

  /// Number of datagrams so far of which not all IP fragments were found.
  [[nodiscard]] std::size_t num_torn() const { return fragments_.num_torn(); }

 private:
  struct Capture;

  [[nodiscard]] std::optional<CapturedDatagram> PutTogether(IpFragment fragment,
                                                            std::int64_t time_ns,
                                                            const std::string& place);

  IpFragments fragments_;
  std::string name_;
  std::size_t num_frames_{};
  std::unique_ptr<Capture> capture_;
};

}  // namespace railcast
