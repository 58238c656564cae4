#include "core/extras/packets/pcap/pcap_writer.h"

#include <pcap/pcap.h>
#include <stdio_ext.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/packets/pcap/internet_checksum.h"
#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

constexpr std::size_t kMaxDatagramSize = 65507;

/// Writes a number in network byte order.
void StoreBigAt(char* place, std::uint16_t number) {
  place[0] = static_cast<char>(number >> 8U);
  place[1] = static_cast<char>(number & 0xFFU);
}

/// Stores the headers of Ethernet and IPv4 and returns where UDP's begins.
char* StoreIpv4Headers(std::uint16_t udp_size, char* frame) {
  // Ethernet broadcast from an address of Velodyne's range; IPv4 without options, don't fragment,
  // 64 hops, UDP; from 192.168.1.201 to 255.255.255.255.
  constexpr std::array<unsigned char, kEthernetSize + kIpv4HeaderSize> kStart = {
      0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x60, 0x76, 0x88, 0,  0,  0,
      0x08, 0x00, 0x45, 0,    0,    0,    0,    0,    0x40, 0,  64, kUdpProtocol,
      0,    0,    192,  168,  1,    201,  255,  255,  255,  255};
  std::memcpy(frame, kStart.data(), kStart.size());
  char* const ip = frame + kEthernetSize;
  StoreBigAt(ip + 2, static_cast<std::uint16_t>(udp_size + kIpv4HeaderSize));
  StoreBigAt(ip + 10, ChecksumOf(AddWords({ip, kIpv4HeaderSize}, 0)));
  return ip + kIpv4HeaderSize;
}

/// As StoreIpv4Headers(), of IPv6 (RFC 8200, 3).
char* StoreIpv6Headers(std::uint16_t udp_size, char* frame) {
  // To the Ethernet address of ff02::1 (RFC 2464, 7) from the same card; UDP, 64 hops; from the
  // card's address of the link (RFC 4291, 2.5.6).
  constexpr std::array<unsigned char, kEthernetSize + kIpv6HeaderSize> kStart = {
      0x33, 0x33, 0,    0,    0,    1,    0x60,
      0x76, 0x88, 0,    0,    0,    0x86, 0xDD,
      0x60, 0,    0,    0,    0,    0,    kUdpProtocol,
      64,   0xFE, 0x80, 0,    0,    0,    0,
      0,    0,    0x62, 0x76, 0x88, 0xFF, 0xFE,
      0,    0,    0,    0xFF, 0x02, 0,    0,
      0,    0,    0,    0,    0,    0,    0,
      0,    0,    0,    0,    1};
  std::memcpy(frame, kStart.data(), kStart.size());
  StoreBigAt(frame + kEthernetSize + 4, udp_size);
  return frame + kEthernetSize + kIpv6HeaderSize;
}

/// The checksum of UDP over IPv6: over both addresses, the length, the protocol and the datagram,
/// whose checksum field is still 0 (RFC 8200, 8.1).
std::uint16_t UdpChecksum(const char* udp, std::uint16_t udp_size) {
  const std::uint64_t pseudo_header =
      AddWords({udp - 32, 32}, std::uint64_t{udp_size} + kUdpProtocol);
  const std::uint16_t sum = ChecksumOf(AddWords({udp, udp_size}, pseudo_header));
  // 0 would mean that there is none.
  return sum == 0 ? 0xFFFF : sum;
}

}  // namespace

void PcapWriter::Close::operator()(pcap_dumper* dumper) const {
  pcap_dump_close(dumper);
}

PcapWriter::PcapWriter(std::filesystem::path file,
                       std::uint16_t data_port,
                       std::uint16_t position_port,
                       bool is_ipv6)
    : file_(std::move(file)),
      target_(FileToReplace(file_)),
      data_port_(data_port),
      position_port_(position_port),
      is_ipv6_(is_ipv6) {
  std::FILE* const stream = std::fopen(unfinished().c_str(), "wbe");
  if (stream == nullptr) throw FileError(file_, errno);
  constexpr int kSnapLength = 65535;
  const std::unique_ptr<pcap_t, decltype(&pcap_close)> format(
      pcap_open_dead(DLT_EN10MB, kSnapLength), pcap_close);
  if (!format) {
    std::fclose(stream);
    throw OutOfMemory("writing " + ShownPath(file_));
  }
  dumper_.reset(pcap_dump_fopen(format.get(), stream));
  if (dumper_) return;
  const int error_number = errno;
  std::fclose(stream);
  throw FileError(file_, error_number);
}

void PcapWriter::Write(const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
  std::array<char, kEthernetSize + kIpv6HeaderSize + kUdpHeaderSize + kMaxDatagramSize> frame;
  for (const Datagrams::Item& item : items) {
    Check(item.size <= kMaxDatagramSize, "a datagram fits a UDP packet");
    const std::span<const char> payload = datagrams.BytesOf(item);
    const std::uint16_t port = item.port == DatagramPort::kData ? data_port_ : position_port_;
    const auto udp_size = static_cast<std::uint16_t>(kUdpHeaderSize + item.size);
    char* const udp = is_ipv6_ ? StoreIpv6Headers(udp_size, frame.data())
                               : StoreIpv4Headers(udp_size, frame.data());
    StoreBigAt(udp, port);
    StoreBigAt(udp + 2, port);
    StoreBigAt(udp + 4, udp_size);
    StoreBigAt(udp + 6, 0);
    std::memcpy(udp + kUdpHeaderSize, payload.data(), payload.size());
    // IPv4 allows that there is no checksum, and the sensors send none.
    if (is_ipv6_) StoreBigAt(udp + 6, UdpChecksum(udp, udp_size));
    const std::int64_t time_us = (item.due_ns + clock_ahead_ns_) / kNsPerUs;
    pcap_pkthdr header{};
    header.ts.tv_sec = kSimulationEpoch_s + time_us / 1'000'000;
    if (header.ts.tv_sec > std::numeric_limits<std::uint32_t>::max()) {
      throw InputError(ShownPath(file_) +
                       ": times in captures must be before 2106-02-07 06:28:16 (got " +
                       NumberText(header.ts.tv_sec) + " s since 1970)");
    }
    header.ts.tv_usec = time_us % 1'000'000;
    header.caplen = header.len = static_cast<bpf_u_int32>(udp + udp_size - frame.data());
    // libpcap's functions take the dumper as a byte pointer.
    pcap_dump(reinterpret_cast<u_char*>(dumper_.get()), &header,
              reinterpret_cast<const u_char*>(frame.data()));
  }
  // Flush after each call, so that a run that is killed leaves all that was written until here.
  std::FILE* const stream = pcap_dump_file(dumper_.get());
  if (pcap_dump_flush(dumper_.get()) == 0 && std::ferror(stream) == 0) {
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
  std::FILE* const stream = pcap_dump_file(dumper_.get());
  if (pcap_dump_flush(dumper_.get()) != 0 || ::fsync(::fileno(stream)) != 0 ||
      ::rename(unfinished().c_str(), target_.c_str()) != 0) {
    throw FileError(file_, errno);
  }
  dumper_.reset();
}

}  // namespace railcast
