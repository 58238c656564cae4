#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "core/io/datagrams.h"

namespace railcast {

/// Writes datagrams as a capture file (classic pcap, Ethernet) of a sensor at 192.168.1.201 that
/// sends to everybody, from and to the same port. Each packet has exactly 42 bytes of headers,
/// which many decoders skip without looking, and the time at which it is due, in microseconds;
/// simulation time 0 is 2000-01-01 00:00:00 UTC.
///
/// While it grows the file is named `file` + kUnfinishedSuffix; Finish() syncs and renames it. What
/// an interrupted run leaves has the unfinished name and can be read up to its last whole packet.
class PcapWriter {
 public:
  /// @param data_port, position_port For the datagrams of either port.
  /// @throws InputError if the file cannot be made, or as FileToReplace does.
  PcapWriter(std::filesystem::path file, std::uint16_t data_port, std::uint16_t position_port);
  ~PcapWriter();
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;

  /// Appends these. @throws InputError if the system refuses, as on a full disk: then the
  /// unfinished
  ///   file holds what was written by the calls before, and the writer is of no more use.
  void Write(const Datagrams& datagrams, std::span<const Datagrams::Item> items);

  /// Completes the file. @throws InputError if the system refuses.
  void Finish();

  /// Where the packets are until Finish().
  [[nodiscard]] std::filesystem::path unfinished() const;

 private:
  struct Dump;

  std::filesystem::path file_;
  std::filesystem::path target_;  ///< What Finish() replaces.
  std::uint16_t data_port_;
  std::uint16_t position_port_;
  std::unique_ptr<Dump> dump_;
  std::int64_t whole_bytes_{};  ///< Of the file after the last Write.
};

}  // namespace railcast
