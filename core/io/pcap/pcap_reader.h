#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace railcast {

/// A UDP datagram of a capture, or several of one size and a last of at most that: where a network
/// card or the loopback device is to cut what was sent at once (UDP segmentation offload), a
/// capture on the sending machine sees it uncut. Only who knows the protocol can tell where to cut.
struct CapturedDatagram {
  std::span<const char> payload;  ///< Valid until the next one is read.
  std::uint16_t source_port{};
  std::uint16_t destination_port{};
  std::int64_t time_ns{};  ///< Since 1970-01-01 00:00:00 UTC.
  std::size_t packet{};    ///< Its place among the packets of the file, from 0.
};

/// The UDP datagram in an Ethernet frame: IPv4 with any options, behind up to two VLAN tags.
/// Nothing if the frame holds none, or only a fragment of one.
[[nodiscard]] std::optional<CapturedDatagram> FindDatagram(std::span<const char> frame);

/// Reads the UDP datagrams of a capture file, classic pcap or pcapng.
class PcapReader {
 public:
  /// @throws InputError "file: reason" if it is no capture of Ethernet frames.
  explicit PcapReader(const std::filesystem::path& file);
  /// @param stream Taken over, closed in any case. @param name What faults call it.
  PcapReader(std::FILE* stream, std::string name);
  ~PcapReader();
  PcapReader(const PcapReader&) = delete;
  PcapReader& operator=(const PcapReader&) = delete;

  /// The next datagram, whatever its port; nothing at the end of the file.
  /// @throws InputError "file: packet 7: reason" where the file is damaged or the capture kept only
  ///   the beginning of a datagram.
  [[nodiscard]] std::optional<CapturedDatagram> Next();

 private:
  struct Capture;

  std::string name_;
  std::size_t num_frames_{};
  std::unique_ptr<Capture> capture_;
};

}  // namespace railcast
