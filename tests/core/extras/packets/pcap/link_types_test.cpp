#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/extras/packets/pcap/pcap_reader.h"
#include "tests/core/extras/packets/pcap/made_capture.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

struct ReadPayloads {
  std::vector<std::string> payloads;
  std::vector<Remark> remarks;
};

ReadPayloads PayloadsIn(const std::filesystem::path& file) {
  PcapReader reader(file);
  ReadPayloads read;
  while (const auto datagram = reader.Next()) {
    EXPECT_EQ(AddressText(datagram->source_address), "192.168.1.201");
    EXPECT_EQ(AddressText(datagram->destination_address), "255.255.255.255");
    read.payloads.emplace_back(datagram->payload.begin(), datagram->payload.end());
  }
  read.remarks = reader.remarks();
  return read;
}

struct LinkFrame {
  std::size_t link{};
  std::string frame;
};

TEST(PcapReader, ReadsWhatLoopbackDevicesAndLinuxsAnyCapture) {
  const std::string ip = IpOf("abc");
  const std::string sll = std::string("\0\0\0\1\0\6\1\2\3\4\5\6\0\0\x08\0", 16);
  const std::string sll2 = std::string("\x08\0\0\0\0\0\0\2\0\1\0\6\1\2\3\4\5\6\0\0", 20);
  const std::string tag("\0\7\x08\0", 4);  // Of a VLAN: its number and the next type.
  const std::vector<LinkFrame> frames = {{0, std::string("\2\0\0\0", 4) + ip},
                                         {0, std::string("\0\0\0\2", 4) + ip},
                                         {1, EthernetOf(ip)},
                                         {12, ip},
                                         {101, ip},
                                         {108, std::string("\0\0\0\2", 4) + ip},
                                         {113, sll + ip},
                                         {113, sll.substr(0, 14) + "\x81" + '\0' + tag + ip},
                                         {228, ip},
                                         {276, sll2 + ip},
                                         {276, "\x91" + ('\0' + sll2.substr(2)) + tag + ip}};
  const TemporaryDirectory directory;
  for (const LinkFrame& each : frames) {
    const ReadPayloads read =
        PayloadsIn(WriteCapture(directory.path() / "a.pcap", {{each.frame}}, each.link));
    EXPECT_EQ(read.payloads, std::vector<std::string>{"abc"}) << each.link;
    EXPECT_TRUE(read.remarks.empty()) << each.link;
  }
}

TEST(PcapReader, SkipsTagsOfVlansOfAnyNumber) {
  const TemporaryDirectory directory;
  for (const char* type : {"\x81\x00", "\x88\xA8", "\x91\x00"}) {
    std::string tags;
    for (int num = 0; num < 5; ++num) {
      const auto file = directory.path() / "a.pcap";
      EXPECT_EQ(PayloadsIn(WriteCapture(file, {{EthernetOf(IpOf("abc"), tags)}})).payloads.size(),
                1U);
      tags += std::string(type, 2) + std::string("\0\7", 2);
    }
  }
}

/// A packet of IPv4 from one switch to another.
std::string OuterIp(char protocol, const std::string& content) {
  return std::string("\x45\0", 2) + Big16(20 + content.size()) + std::string(4, '\0') + '\x40' +
         protocol + std::string(2, '\0') + std::string("\x0A\0\0\1\x0A\0\0\2", 8) + content;
}

std::string OuterUdp(std::size_t port, const std::string& content) {
  return OuterIp('\x11',
                 Big16(49'000) + Big16(port) + Big16(8 + content.size()) + Big16(0) + content);
}

std::string OuterGre(std::size_t flags, std::size_t type, const std::string& content) {
  return OuterIp('\x2F', Big16(flags) + Big16(type) + content);
}

/// The frame of a mirrored port in each kind of packet that carries it.
std::vector<std::string> TunnelsWith(const std::string& ip) {
  const std::string frame = EthernetOf(ip);
  const std::string tagged = EthernetOf(ip, std::string("\x81\0\0\7", 4));
  const std::string vxlan = std::string("\x08\0\0\0\0\0\x2A\0", 8);
  const std::string number(4, '\1');
  const std::string ipv6 = std::string("\x60\0\0\0", 4) + Big16(ip.size()) +
                           std::string("\x04\x40", 2) + std::string(32, '\x20') + ip;
  return {
      EthernetOf(OuterUdp(4789, vxlan + frame)),
      EthernetOf(OuterUdp(8472, vxlan + tagged)),
      EthernetOf(OuterUdp(4789, vxlan + EthernetOf(OuterUdp(4789, vxlan + frame)))),
      EthernetOf(OuterUdp(6081, std::string("\2\0\x65\x58\0\0\1\0", 8) + number + number + frame)),
      EthernetOf(OuterUdp(6081, std::string("\0\0\x08\0\0\0\1\0", 8) + ip)),
      EthernetOf(OuterUdp(2152, "\x30\xFF" + Big16(ip.size()) + number + ip)),
      EthernetOf(OuterUdp(2152, "\x34\xFF" + Big16(8 + ip.size()) + number +
                                    std::string("\0\1\0\x85\1\x10\5\0", 8) + ip)),
      EthernetOf(OuterUdp(37008, std::string("\1\0\0\1\0\x0A\1\x42\1", 9) + frame)),
      EthernetOf(OuterGre(0, 0x6558, frame)),
      EthernetOf(OuterGre(0xB000, 0x0800, number + number + number + ip)),
      EthernetOf(OuterGre(0, 0x88BE, frame)),
      EthernetOf(OuterGre(0x1000, 0x88BE, number + number + number + tagged)),
      EthernetOf(OuterGre(0x1000, 0x22EB, number + std::string(12, '\2') + frame)),
      EthernetOf(
          OuterGre(0x1000, 0x22EB, number + std::string(12, '\3') + number + number + frame)),
      EthernetOf(OuterIp('\4', ip)),
      std::string(12, '\xAA') + "\x86\xDD" + ipv6};
}

TEST(PcapReader, ReadsWhatMirroredPortsAndTunnelsCarry) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  for (const std::string& frame : TunnelsWith(IpOf("abc"))) {
    const ReadPayloads read = PayloadsIn(WriteCapture(file, {{frame}}));
    EXPECT_EQ(read.payloads, std::vector<std::string>{"abc"}) << frame;
    EXPECT_TRUE(read.remarks.empty()) << frame;
    // Of those that a capture cuts, at any place, nothing is made up.
    for (std::size_t size = 0; size < frame.size(); ++size) {
      EXPECT_TRUE(PayloadsIn(WriteCapture(file, {{frame.substr(0, size)}})).payloads.empty());
    }
  }
}

// What only goes to such a port is no tunnel.
TEST(PcapReader, TakesNoOtherDatagramsForTunnels) {
  const TemporaryDirectory directory;
  for (const std::size_t port : {4789U, 8472U, 6081U, 2152U, 37008U}) {
    const std::string payload = std::string("\x08\xEE\xFF", 3) + std::string(1203, '\x55');
    const std::string frame = EthernetOf(IpOf(payload, '\xC9', 2368, port));
    EXPECT_EQ(PayloadsIn(WriteCapture(directory.path() / "a.pcap", {{frame}})).payloads,
              std::vector<std::string>{payload})
        << port;
  }
}

TEST(PcapReader, CountsFramesOfUnknownTypes) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  std::string mpls = EthernetOf(IpOf("abc"));
  mpls.replace(12, 2, "\x88\x47");
  std::string arp = mpls;
  arp.replace(12, 2, "\x08\x06");
  const ReadPayloads read =
      PayloadsIn(WriteCapture(file, {{EthernetOf(IpOf("d"))}, {arp}, {mpls}, {mpls}}));
  EXPECT_EQ(read.payloads.size(), 1U);
  ASSERT_EQ(read.remarks.size(), 1U);
  EXPECT_EQ(
      read.remarks[0].Text(),
      "2 frames of the network of an unknown type or wrong length: type 0x8847 (the first in " +
          file.string() + ": packet 2)");
}

TEST(PcapReader, CountsFramesWithoutTheLengthsThatTheyState) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  std::string udp = EthernetOf(IpOf("abc"));
  udp.replace(38, 2, Big16(12));
  std::string ip = EthernetOf(IpOf("abc"));
  ip.replace(16, 2, Big16(32));
  const ReadPayloads read = PayloadsIn(WriteCapture(file, {{EthernetOf(IpOf("d"))}, {udp}, {ip}}));
  EXPECT_EQ(read.payloads.size(), 1U);
  ASSERT_EQ(read.remarks.size(), 1U);
  EXPECT_EQ(read.remarks[0].Text(),
            "2 frames of the network of an unknown type or wrong length: a length of IP or UDP "
            "that the frame does not have (the first in " +
                file.string() + ": packet 1)");
}

/// A capture of three frames in pcapng, after draft-tuexen-opsawg-pcapng.
std::string NextGeneration(const std::string& frame) {
  const std::string padded = frame + std::string((4 - frame.size() % 4) % 4, '\0');
  std::string bytes = "\x0A\x0D\x0D\x0A" + Little32(28) + "\x4D\x3C\x2B\x1A" +
                      std::string("\1\0\0\0", 4) + std::string(8, '\xFF') + Little32(28);
  bytes += Little32(1) + Little32(20) + Little32(1) + Little32(0) + Little32(20);
  for (int i = 0; i < 3; ++i) {
    const std::string size = Little32(32 + padded.size());
    bytes += Little32(6) + size + std::string(12, '\0') + Little32(frame.size()) +
             Little32(frame.size()) + padded + size;
  }
  return bytes;
}

TEST(PcapReader, ReadsACaptureThatEndsWithinAPacketUpToThat) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  const std::string frame = EthernetOf(IpOf("abc"));
  WriteCapture(file, {{frame}, {frame}, {frame}});
  const std::string classic = ReadFileWhole(file);
  for (const std::string& whole : {classic, NextGeneration(frame)}) {
    for (const std::size_t num_cut : {1U, 20U, 50U}) {
      WriteFileWhole(file, whole.substr(0, whole.size() - num_cut));
      const ReadPayloads read = PayloadsIn(file);
      EXPECT_EQ(read.payloads.size(), 2U);
      ASSERT_EQ(read.remarks.size(), 1U);
      EXPECT_EQ(read.remarks[0].Text(),
                "1 recording that ends within a record (in " + file.string() + ": packet 2)");
    }
    WriteFileWhole(file, whole);
    EXPECT_EQ(PayloadsIn(file).payloads.size(), 3U);
    EXPECT_TRUE(PayloadsIn(file).remarks.empty());
  }
}

std::string WithChecksum(std::size_t checksum) {
  return EthernetOf(IpOf("abc"))
      .replace(kEthernetSize + kIpv4HeaderSize + kUdpChecksumPlace, 2, Big16(checksum));
}

// Of "abc" from 192.168.1.201 to 255.255.255.255, by hand after RFC 768: 0x6684.
TEST(PcapReader, KnowsDatagramsThatDoNotAgreeWithTheirChecksums) {
  const TemporaryDirectory directory;
  for (const auto& [checksum, is_wrong] :
       std::vector<std::pair<std::size_t, bool>>{{0, false}, {0x6684, false}, {0x6685, true}}) {
    PcapReader reader(WriteCapture(directory.path() / "a.pcap", {{WithChecksum(checksum)}}));
    EXPECT_EQ(reader.Next()->has_wrong_checksum, is_wrong) << checksum;
  }
}

}  // namespace
}  // namespace railcast
