#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "core/io/datagrams.h"

struct pcap_dumper;

namespace railcast {

/// Writes datagrams as a capture file (classic pcap, Ethernet) of a sensor at 192.168.1.201 that
/// broadcasts, with equal source and destination ports. Each packet has exactly 42 bytes of
/// headers, which many decoders skip unread, and is stamped in microseconds with the time at which
/// it is due; simulation time 0 is 2000-01-01 00:00:00 UTC.
///
/// Of IPv6 there are 62 bytes of headers, and packets go from the link-local address of the
/// sensor's network card to all nodes of the link, ff02::1, with the checksum that UDP has there.
///
/// While it grows the file is named `file` + kUnfinishedSuffix; Finish() syncs and renames it. An
/// interrupted run leaves the file under its unfinished name; it can be read up to its last whole
/// packet.
class PcapWriter final : public DatagramFile {
 public:
  /// @param data_port, position_port The ports of the two kinds of datagrams.
  /// @throws InputError if the file cannot be created, or as FileToReplace does.
  PcapWriter(std::filesystem::path file,
             std::uint16_t data_port,
             std::uint16_t position_port,
             bool is_ipv6 = false);
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;

  void SetClockAhead(std::int64_t ahead_ns) override { clock_ahead_ns_ = ahead_ns; }
  /// @throws InputError also at times after the 32 unsigned bits of classic captures' seconds. The
  ///   unfinished file then holds what earlier calls wrote.
  void Write(const Datagrams& datagrams, std::span<const Datagrams::Item> items) override;
  void Finish() override;
  [[nodiscard]] std::filesystem::path unfinished() const override;

 private:
  struct Close {
    void operator()(pcap_dumper* dumper) const;
  };

  std::filesystem::path file_;
  std::filesystem::path target_;  ///< The file that Finish() replaces.
  std::uint16_t data_port_;
  std::uint16_t position_port_;
  bool is_ipv6_;
  std::unique_ptr<pcap_dumper, Close> dumper_;
  std::int64_t clock_ahead_ns_{};
  std::int64_t whole_bytes_{};  ///< Size of the file after the last complete Write.
};

}  // namespace railcast
