#include "core/io/pcap/pcap_writer.h"

#include <pcap/pcap.h>
#include <stdio_ext.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/io/velodyne/velodyne_packet.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

constexpr std::size_t kHeaderSize = 42;  // Ethernet 14, IPv4 20, UDP 8.
constexpr std::size_t kIpPlace = 14;
constexpr std::size_t kUdpPlace = 34;
constexpr std::size_t kMaxDatagramSize = 65507;

/// Writes a number in network byte order.
void StoreBigAt(char* place, std::uint16_t number) {
  place[0] = static_cast<char>(number >> 8U);
  place[1] = static_cast<char>(number & 0xFFU);
}

// The checksum of RFC 1071 over an IPv4 header whose checksum field is still 0.
std::uint16_t IpChecksum(const char* header) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < 20; i += 2) {
    sum += static_cast<std::uint32_t>(static_cast<unsigned char>(header[i]) << 8U) +
           static_cast<unsigned char>(header[i + 1]);
  }
  while (sum >> 16U != 0) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum);
}

void StoreHeaders(std::uint16_t payload_size, std::uint16_t port, char* frame) {
  // Ethernet broadcast from an address of Velodyne's range; IPv4 without options, don't fragment,
  // 64 hops, UDP; from 192.168.1.201 to 255.255.255.255.
  constexpr std::array<unsigned char, kUdpPlace> kStart = {
      0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x60, 0x76, 0x88, 0,   0, 0,   0x08, 0x00, 0x45, 0,  0, 0,
      0,    0,    0x40, 0,    64,   17,   0,    0,    192,  168, 1, 201, 255,  255,  255,  255};
  std::memcpy(frame, kStart.data(), kStart.size());
  const auto udp_size = static_cast<std::uint16_t>(payload_size + 8);
  StoreBigAt(frame + kIpPlace + 2, static_cast<std::uint16_t>(udp_size + 20));
  StoreBigAt(frame + kIpPlace + 10, IpChecksum(frame + kIpPlace));
  StoreBigAt(frame + kUdpPlace, port);
  StoreBigAt(frame + kUdpPlace + 2, port);
  StoreBigAt(frame + kUdpPlace + 4, udp_size);
  // No checksum: IPv4 allows that, and the sensors send none.
  StoreBigAt(frame + kUdpPlace + 6, 0);
}

}  // namespace

struct PcapWriter::Dump {
  pcap_t* format{};
  pcap_dumper_t* dumper{};

  Dump() = default;
  Dump(const Dump&) = delete;
  Dump& operator=(const Dump&) = delete;
  ~Dump() {
    if (dumper != nullptr) pcap_dump_close(dumper);
    if (format != nullptr) pcap_close(format);
  }
};

PcapWriter::PcapWriter(std::filesystem::path file,
                       std::uint16_t data_port,
                       std::uint16_t position_port)
    : file_(std::move(file)),
      target_(FileToReplace(file_)),
      data_port_(data_port),
      position_port_(position_port),
      dump_(std::make_unique<Dump>()) {
  std::FILE* const stream = std::fopen(unfinished().c_str(), "wbe");
  if (stream == nullptr) throw FileError(file_, errno);
  constexpr int kSnapLength = 65535;
  dump_->format = pcap_open_dead(DLT_EN10MB, kSnapLength);
  if (dump_->format == nullptr) {
    std::fclose(stream);
    throw OutOfMemory("writing " + ShownPath(file_));
  }
  dump_->dumper = pcap_dump_fopen(dump_->format, stream);
  if (dump_->dumper != nullptr) return;
  const int error_number = errno;
  std::fclose(stream);
  throw FileError(file_, error_number);
}

PcapWriter::~PcapWriter() = default;

void PcapWriter::Write(const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
  std::array<char, kHeaderSize + kMaxDatagramSize> frame;
  for (const Datagrams::Item& item : items) {
    Check(item.size <= kMaxDatagramSize, "a datagram fits a UDP packet");
    const std::span<const char> payload = datagrams.BytesOf(item);
    const bool is_data = item.port == DatagramPort::kData;
    StoreHeaders(static_cast<std::uint16_t>(item.size), is_data ? data_port_ : position_port_, frame.data());
    std::memcpy(frame.data() + kHeaderSize, payload.data(), payload.size());
    const std::int64_t time_us = (item.due_ns + clock_ahead_ns_) / 1000;
    pcap_pkthdr header{};
    header.ts.tv_sec = kSimulationEpoch_s + time_us / 1'000'000;
    header.ts.tv_usec = time_us % 1'000'000;
    header.caplen = header.len = static_cast<bpf_u_int32>(kHeaderSize + payload.size());
    // libpcap's functions take the dumper as a byte pointer.
    pcap_dump(reinterpret_cast<u_char*>(dump_->dumper), &header,
              reinterpret_cast<const u_char*>(frame.data()));
  }
  // Flush after each call, so that a run that is killed leaves all that was written until here.
  std::FILE* const stream = pcap_dump_file(dump_->dumper);
  if (pcap_dump_flush(dump_->dumper) == 0 && std::ferror(stream) == 0) {
    whole_bytes_ = std::ftell(stream);
    return;
  }
  const InputError error = FileError(file_, errno);
  // Discard the buffer and cut the file back: it must not end with half a packet, nor may closing
  // it append the buffer should the disk have room again by then.
  ::__fpurge(stream);
  static_cast<void>(!::ftruncate(::fileno(stream), whole_bytes_));
  throw error;
}

std::filesystem::path PcapWriter::unfinished() const {
  return target_.string() + std::string(kUnfinishedSuffix);
}

void PcapWriter::Finish() {
  std::FILE* const stream = pcap_dump_file(dump_->dumper);
  if (pcap_dump_flush(dump_->dumper) != 0 || ::fsync(::fileno(stream)) != 0 ||
      ::rename(unfinished().c_str(), target_.c_str()) != 0) {
    throw FileError(file_, errno);
  }
  dump_.reset();
}

}  // namespace railcast
