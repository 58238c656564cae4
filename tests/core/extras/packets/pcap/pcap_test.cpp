#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/pcap/pcap_writer.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/small_disk.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/captures.h"
#include "tests/support/faults.h"
#include "tests/support/made_datagrams.h"
#include "tests/support/run_command.h"
#include "tests/support/written_file.h"

namespace railcast {
namespace {

constexpr std::int64_t kEpoch_ns = 946'684'800'000'000'000;

/// Three datagrams: one of 1206 bytes, one of 512 for the position port, and an empty one.
Datagrams ExampleDatagrams() {
  Datagrams datagrams;
  datagrams.bytes.resize(1206 + 512);
  for (std::size_t i = 0; i < datagrams.bytes.size(); ++i) {
    datagrams.bytes[i] = static_cast<char>(i * 7);
  }
  datagrams.items = {{0, 1206, DatagramPort::kData, 1'327'123},
                     {1206, 512, DatagramPort::kPosition, 1'000'000'000},
                     {1718, 0, DatagramPort::kData, 86'400'000'001'000}};
  return datagrams;
}

void WriteExample(const std::filesystem::path& file) {
  WriteDatagrams(file, ExampleDatagrams());
}

std::string ReadAll(const std::filesystem::path& file) {
  return MessageOf([&] { (void)PacketsInCapture(file); });
}

/// The same of these bytes, without the name of the file.
std::string SaidOf(const std::string& bytes) {
  const WrittenFile file("a.pcap", bytes);
  return MessageBehind(file.path().string() + ": ", [&] { (void)PacketsInCapture(file.path()); });
}

TEST(Pcap, ReadsBackWhatItWrote) {
  const TemporaryDirectory directory;
  WriteExample(directory.path() / "a.pcap");
  EXPECT_FALSE(exists(directory.path() / "a.pcap.part"));
  const Datagrams datagrams = ExampleDatagrams();
  PcapReader reader(directory.path() / "a.pcap");
  for (const Datagrams::Item& item : datagrams.items) {
    const auto datagram = reader.Next();
    ASSERT_TRUE(datagram);
    EXPECT_TRUE(std::ranges::equal(datagram->payload, datagrams.BytesOf(item)));
    const std::uint16_t port = item.port == DatagramPort::kData ? 2368 : 8308;
    EXPECT_EQ(datagram->source_port, port);
    EXPECT_EQ(datagram->destination_port, port);
    EXPECT_EQ(datagram->time_ns, kEpoch_ns + item.due_ns / 1000 * 1000);
  }
  EXPECT_FALSE(reader.Next());
}

TEST(Pcap, KeepsTimesAfter2038UntilTheEndOf32Bits) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  constexpr std::int64_t kLast_s = 0xFFFF'FFFF;  // 2106-02-07 06:28:15.
  for (const std::int64_t time_s : {std::int64_t{0x8000'0000}, kLast_s}) {
    Datagrams datagrams = ExampleDatagrams();
    datagrams.items = {{0, 1206, DatagramPort::kData, 250'000'000}};
    PcapWriter writer(file, 2368, 8308);
    writer.SetClockAhead(time_s * 1'000'000'000 - kEpoch_ns);
    writer.Write(datagrams, datagrams.items);
    writer.Finish();
    EXPECT_EQ(PcapReader(file).Next()->time_ns, time_s * 1'000'000'000 + 250'000'000);
  }
}

TEST(PcapWriter, RefusesTimesThatItsSecondsCannotHold) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  const Datagrams datagrams = ExampleDatagrams();
  PcapWriter writer(file, 2368, 8308);
  writer.SetClockAhead(0x1'0000'0000 * 1'000'000'000 - kEpoch_ns);
  EXPECT_EQ(MessageOf([&] { writer.Write(datagrams, datagrams.items); }),
            file.string() +
                ": times in captures must be before 2106-02-07 06:28:16 "
                "(got 4294967296 s since 1970)");
}

TEST(PcapWriter, WritesTheHeadersThatDecodersSkip) {
  const TemporaryDirectory directory;
  WriteExample(directory.path() / "a.pcap");
  const std::string bytes = ReadFileWhole(directory.path() / "a.pcap");
  ASSERT_EQ(bytes.size(), 24U + 3 * (16 + 42) + 1206 + 512);
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const auto bytes_at = [&](std::size_t place, std::size_t size) {
    std::vector<int> values;
    for (std::size_t i = 0; i < size; ++i) values.push_back(byte(place + i));
    return values;
  };
  EXPECT_THAT(bytes_at(0, 8), testing::ElementsAre(0xD4, 0xC3, 0xB2, 0xA1, 2, 0, 4, 0));
  EXPECT_THAT(bytes_at(20, 4), testing::ElementsAre(1, 0, 0, 0));  // Link type: Ethernet.
  constexpr std::size_t kIp = 24 + 16 + 14;
  EXPECT_THAT(bytes_at(kIp - 2, 4), testing::ElementsAre(0x08, 0x00, 0x45, 0x00));
  EXPECT_EQ(256 * byte(kIp + 2) + byte(kIp + 3), 1206 + 28);
  EXPECT_EQ(byte(kIp + 9), 17);
  EXPECT_THAT(bytes_at(kIp + 12, 8), testing::ElementsAre(192, 168, 1, 201, 255, 255, 255, 255));
  EXPECT_THAT(bytes_at(kIp + 20, 8),
              testing::ElementsAre(0x09, 0x40, 0x09, 0x40, 0x04, 0xBE, 0x00, 0x00));
  // The one's complement sum over a valid header is all ones (RFC 1071).
  unsigned sum = 0;
  for (std::size_t i = 0; i < 20; i += 2) sum += 256U * byte(kIp + i) + byte(kIp + i + 1);
  EXPECT_EQ((sum & 0xFFFFU) + (sum >> 16U), 0xFFFFU);
}

/// Writes a capture of IPv6 with datagrams of these payloads.
void WriteIpv6(const std::filesystem::path& file, const std::vector<std::string>& payloads) {
  WriteDatagrams(file, DatagramsWith(payloads), 2368, 8308, /*is_ipv6=*/true);
}

// Made by hand after RFC 8200 (3; 8.1) and RFC 768: the sum of fe80::6276:88ff:fe00:0, ff02::1, 11,
// 17, 0x0940, 0x0940, 11, 0x6162 and 0x6300 is 0xBE05, of which 0x41FA is the complement.
constexpr std::array<unsigned char, 65> kIpv6Frame = {
    0x33, 0x33, 0,    0,    0,    1,    0x60, 0x76, 0x88, 0,    0,    0,   0x86,
    0xDD, 0x60, 0,    0,    0,    0,    11,   17,   64,   0xFE, 0x80, 0,   0,
    0,    0,    0,    0,    0x62, 0x76, 0x88, 0xFF, 0xFE, 0,    0,    0,   0xFF,
    0x02, 0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,   0,
    0,    1,    0x09, 0x40, 0x09, 0x40, 0,    11,   0x41, 0xFA, 'a',  'b', 'c'};

TEST(PcapWriter, WritesPacketsOfIpv6WithTheirChecksum) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  // The sum of the second is 0, which UDP writes as 0xFFFF.
  WriteIpv6(file, {"abc", "\x06\x5F"});
  const std::string bytes = ReadFileWhole(file);
  constexpr std::size_t kFirst = 24 + 16;
  ASSERT_EQ(bytes.size(), kFirst + kIpv6Frame.size() + 16 + 64);
  const std::string expected(kIpv6Frame.begin(), kIpv6Frame.end());
  EXPECT_EQ(bytes.substr(kFirst, expected.size()), expected);
  EXPECT_EQ(bytes.substr(bytes.size() - 4), "\xFF\xFF\x06\x5F");
  PcapReader reader(file);
  const auto first = reader.Next();
  ASSERT_TRUE(first);
  EXPECT_EQ(std::string(first->payload.begin(), first->payload.end()), "abc");
  EXPECT_EQ(first->source_port, 2368);
  EXPECT_EQ(first->destination_port, 2368);
}

TEST(PcapWriter, WritesIpv6ThatTsharkFindsSound) {
  if (!HasTshark()) GTEST_SKIP() << "tshark is missing";
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  WriteIpv6(file, {"abc", "\x06\x5F", std::string(1206, 'v'), std::string(24'832, 'o')});
  const Ended run = RunCommand("tshark -r " + file.string() +
                               " -o udp.check_checksum:TRUE -T fields -E separator=, -e ipv6.src "
                               "-e ipv6.dst -e udp.dstport -e udp.length -e udp.checksum.status "
                               "2>/dev/null");
  std::string expected;
  for (const char* length : {"11", "10", "1214", "24840"}) {
    expected += "fe80::6276:88ff:fe00:0,ff02::1,2368," + std::string(length) + ",1\n";
  }
  EXPECT_EQ(run.said, expected);
}

TEST(PcapWriter, LeavesWholePacketsWhereItIsInterrupted) {
  const TemporaryDirectory directory;
  const Datagrams datagrams = ExampleDatagrams();
  {
    PcapWriter writer(directory.path() / "a.pcap", 2368, 8308);
    writer.Write(datagrams, datagrams.items);
    // This is what a killed run would leave now.
    PcapReader reader(directory.path() / "a.pcap.part");
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(reader.Next());
    EXPECT_FALSE(reader.Next());
  }
  EXPECT_FALSE(exists(directory.path() / "a.pcap"));
  EXPECT_EQ(ReadAll(directory.path() / "a.pcap.part"), "no error");
}

TEST(PcapWriter, SaysThatTheDiskIsFull) {
  const TemporaryDirectory directory;
  const auto result = RunOnSmallDisk(directory.path(), [](const std::filesystem::path& disk) {
    const Datagrams datagrams = ExampleDatagrams();
    return MessageOf([&] {
      PcapWriter writer(disk / "a.pcap", 2368, 8308);
      for (int i = 0; i < 1000; ++i) writer.Write(datagrams, datagrams.items);
      writer.Finish();
    });
  });
  if (!result.refused.empty()) GTEST_SKIP() << result.refused;
  EXPECT_EQ(result.said, (directory.path() / "a.pcap").string() + ": no space left on device");
}

TEST(PcapWriter, LeavesWholePacketsOnAFullDisk) {
  const TemporaryDirectory directory;
  const auto result = RunOnSmallDisk(directory.path(), [](const std::filesystem::path& disk) {
    const Datagrams datagrams = ExampleDatagrams();
    std::uintmax_t num_written = 0;
    const std::string said = MessageOf([&] {
      PcapWriter writer(disk / "a.pcap", 2368, 8308);
      for (; num_written < 1000; ++num_written) writer.Write(datagrams, datagrams.items);
    });
    const std::uintmax_t size = 24 + num_written * (3 * (16 + 42) + 1206 + 512);
    const bool is_whole = std::filesystem::file_size(disk / "a.pcap.part") == size;
    return said + (is_whole ? ", whole; " : ", torn; ") + ReadAll(disk / "a.pcap.part");
  });
  if (!result.refused.empty()) GTEST_SKIP() << result.refused;
  EXPECT_EQ(result.said,
            (directory.path() / "a.pcap").string() + ": no space left on device, whole; no error");
}

TEST(PcapWriter, ReplacesNothingButARegularFileAndLeavesLinks) {
  const TemporaryDirectory directory;
  const std::filesystem::path fifo = directory.path() / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_EQ(MessageOf([&] { WriteExample(fifo); }),
            fifo.string() + ": must be a regular file (got a FIFO)");
  EXPECT_TRUE(std::filesystem::is_fifo(fifo));
  const std::filesystem::path link = directory.path() / "link";
  std::filesystem::create_symlink("a.pcap", link);
  WriteExample(link);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_TRUE(std::filesystem::is_regular_file(directory.path() / "a.pcap"));
}

TEST(PcapWriter, SaysThatItsFileCannotBeMade) {
  EXPECT_EQ(MessageOf([] { const PcapWriter writer("/no/such/place/a.pcap", 2368, 8308); }),
            "/no/such/place/a.pcap: no such file or directory");
}

/// Returns a frame around "abc", sent from port 1 to port 2.
std::vector<char> MadeEthernetFrame(const std::string& tags = {}, const std::string& options = {}) {
  std::string ip = std::string("\x45\0\0\0\0\0\0\0\x40\x11\0\0\x7F\0\0\1\x7F\0\0\1", 20) + options +
                   std::string("\0\1\0\2\0\x0B\0\0abc", 11);
  ip[0] = static_cast<char>(0x40U + 5 + options.size() / 4);
  ip[3] = static_cast<char>(ip.size());
  const std::string frame =
      std::string(12, '\xAA') + tags + std::string("\x08\0", 2) + ip + "padding";
  return {frame.begin(), frame.end()};
}

std::string PayloadOf(const std::vector<char>& frame) {
  const auto found = FindDatagram(frame);
  if (!found) return "nothing";
  EXPECT_EQ(found->source_port, 1);
  EXPECT_EQ(found->destination_port, 2);
  return {found->payload.begin(), found->payload.end()};
}

TEST(FindDatagram, SkipsTagsOptionsAndPadding) {
  const std::string tag("\x81\x00\x00\x05", 4);
  const std::string service_tag("\x88\xA8\x00\x05", 4);
  EXPECT_EQ(PayloadOf(MadeEthernetFrame()), "abc");
  EXPECT_EQ(PayloadOf(MadeEthernetFrame(tag)), "abc");
  EXPECT_EQ(PayloadOf(MadeEthernetFrame(service_tag + tag)), "abc");
  EXPECT_EQ(PayloadOf(MadeEthernetFrame(tag + tag + tag)), "abc");
  EXPECT_EQ(PayloadOf(MadeEthernetFrame("", "optionsoptionsoptionsoptions")), "abc");
}

// The frame is cut anywhere before its padding.
void ExpectNothingWhereCut(const std::vector<char>& sound) {
  for (std::size_t size = 0; size + 7 < sound.size(); ++size) {
    EXPECT_EQ(PayloadOf({sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(size)}),
              "nothing")
        << size;
  }
}

std::string PayloadWith(std::vector<char> frame, std::size_t place, int value) {
  frame[place] = static_cast<char>(value);
  return PayloadOf(frame);
}

TEST(FindDatagram, FindsNothingInWhatIsNoWholeDatagram) {
  const std::vector<char> sound = MadeEthernetFrame();
  ExpectNothingWhereCut(sound);
  const auto with = [&](std::size_t place, int value) { return PayloadWith(sound, place, value); };
  EXPECT_EQ(with(13, 0x06), "nothing");  // ARP.
  EXPECT_EQ(with(14, 0x65), "nothing");  // IP version 6.
  EXPECT_EQ(with(14, 0x44), "nothing");  // Header of 16 bytes.
  EXPECT_EQ(with(14, 0x4F), "nothing");  // Header of 60 bytes.
  EXPECT_EQ(with(16, 0x7F), "nothing");  // Longer than the frame.
  EXPECT_EQ(with(20, 0x20), "nothing");  // The first of several fragments.
  EXPECT_EQ(with(21, 0x01), "nothing");  // A later fragment.
  EXPECT_EQ(with(23, 6), "nothing");     // TCP.
  EXPECT_EQ(with(39, 7), "nothing");     // Shorter than UDP's header.
  EXPECT_EQ(with(39, 12), "nothing");    // Longer than the packet.
}

/// The frame of kIpv6Frame with ports 1 and 2, and headers between IPv6's and UDP's.
/// @param next The number of the first of them.
std::vector<char> MadeIpv6Frame(const std::string& extensions = {}, char next = 17) {
  std::string frame(kIpv6Frame.begin(), kIpv6Frame.end());
  frame.replace(54, 4, std::string("\0\1\0\2", 4));
  frame[19] = static_cast<char>(11 + extensions.size());
  frame[20] = next;
  frame.insert(54, extensions);
  frame += "padding";
  return {frame.begin(), frame.end()};
}

TEST(FindDatagram, SkipsExtensionHeadersOfIpv6) {
  EXPECT_EQ(PayloadOf(MadeIpv6Frame()), "abc");
  // RFC 8200, 4.3 and 4.6: options of 16 and of 8 bytes, here but padding.
  const std::string hop_by_hop("\x3C\1\1\x0C\0\0\0\0\0\0\0\0\0\0\0\0", 16);
  const std::string destination("\x11\0\1\4\0\0\0\0", 8);
  EXPECT_EQ(PayloadOf(MadeIpv6Frame(hop_by_hop + destination, 0)), "abc");
  // 4.4: a routing header without segments left; 4.5: a fragment that is the whole.
  const std::string routing("\x2C\0\0\0\0\0\0\0", 8);
  const std::string fragment("\x11\0\0\0\0\0\0\7", 8);
  EXPECT_EQ(PayloadOf(MadeIpv6Frame(routing + fragment, 43)), "abc");
}

// RFC 8200, 3 and 6: its 20 bits, which Linux fills, say nothing of fragments.
TEST(FindDatagram, TakesNoFlowLabelOfIpv6ForAFragment) {
  std::vector<char> frame = MadeIpv6Frame();
  frame[16] = '\x5A';
  frame[17] = '\x25';
  EXPECT_EQ(PayloadOf(frame), "abc");
}

TEST(FindDatagram, FindsNothingInIpv6ThatIsNoWholeDatagram) {
  const std::string options("\x11\0\1\4\0\0\0\0", 8);
  const std::vector<char> sound = MadeIpv6Frame(options, 60);
  EXPECT_EQ(PayloadOf(sound), "abc");
  ExpectNothingWhereCut(sound);
  const auto with = [&](std::size_t place, int value) { return PayloadWith(sound, place, value); };
  EXPECT_EQ(with(13, 0xDE), "nothing");  // Another protocol.
  EXPECT_EQ(with(14, 0x45), "nothing");  // IP version 4.
  EXPECT_EQ(with(18, 0x7F), "nothing");  // Longer than the frame.
  EXPECT_EQ(with(19, 18), "nothing");    // UDP is longer than the packet.
  EXPECT_EQ(with(20, 6), "nothing");     // TCP.
  EXPECT_EQ(with(20, 59), "nothing");    // Nothing follows.
  EXPECT_EQ(with(54, 6), "nothing");     // TCP behind the options.
  EXPECT_EQ(with(55, 1), "nothing");     // Options that take part of UDP's header.
  EXPECT_EQ(with(55, 2), "nothing");     // Options that end behind the packet.
  EXPECT_EQ(with(55, 255), "nothing");
  for (const char more : {'\1', '\x08'}) {  // The first of several fragments, and a later one.
    const std::string fragment({17, 0, 0, more, 0, 0, 0, 7});
    EXPECT_EQ(PayloadOf(MadeIpv6Frame(fragment, 44)), "nothing");
  }
}

TEST(PcapReader, SaysThatIpv6IsNotCapturedWhole) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  WriteIpv6(file, {"abc"});
  const std::string sound = ReadFileWhole(file);
  const auto said = [&](std::size_t kept, char protocol) {
    std::string cut = sound.substr(0, 24 + 16 + kept);
    cut[24 + 8] = static_cast<char>(kept);
    if (kept > 20) cut[24 + 16 + 20] = protocol;
    return SaidOf(cut);
  };
  for (const std::size_t kept : {20U, 50U, 60U, 64U}) {
    EXPECT_EQ(said(kept, 17),
              "packet 0: must be captured whole (got " + std::to_string(kept) + " of 65 bytes)");
  }
  EXPECT_EQ(said(60, 6), "no error") << "TCP";
}

TEST(PcapReader, SaysWhereAFileIsDamaged) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  WriteExample(file);
  const std::string sound = ReadFileWhole(file);

  EXPECT_EQ(SaidOf(""), "truncated dump file; tried to read 4 file header bytes, only got 0");
  EXPECT_EQ(SaidOf("this is no capture, far from it"), "unknown file format");
  EXPECT_EQ(SaidOf(sound.substr(0, 20)),
            "truncated dump file; tried to read 24 file header bytes, only got 16");
  std::string other_link = sound;
  other_link[20] = 105;
  EXPECT_EQ(
      SaidOf(other_link),
      "must be a capture of Ethernet, of Linux's \"any\" (SLL, SLL2), of a loopback device or "
      "of IP (got IEEE802_11)");
  std::string cut = sound;
  cut[24 + 12 + 1] = 9;  // 2528 bytes on the wire.
  EXPECT_EQ(SaidOf(cut), "no error") << "the datagram is there in full";
  // The capture kept 100 bytes of a frame.
  std::string snapped = sound.substr(0, 24 + 16 + 100);
  snapped[24 + 8] = 100;
  snapped[24 + 9] = 0;
  EXPECT_EQ(SaidOf(snapped), "packet 0: must be captured whole (got 100 of 1248 bytes)");
  std::string too_short = sound.substr(0, 24 + 16 + 20);
  too_short[24 + 8] = 20;
  too_short[24 + 9] = 0;
  EXPECT_EQ(SaidOf(too_short), "packet 0: must be captured whole (got 20 of 1248 bytes)");
  // A frame of another protocol may be cut anywhere.
  const std::size_t ethernet = 24 + 16;
  for (const auto& [place, value] : {std::pair<std::size_t, char>{ethernet + 14 + 9, 6},
                                     {ethernet + 14, 0x65},
                                     {ethernet + 13, 0x06}}) {
    std::string other = snapped + sound.substr(24);
    other[place] = value;
    EXPECT_EQ(SaidOf(other), "no error") << place;
  }
  std::string huge = sound;
  huge[24 + 11] = 0x7F;
  EXPECT_THAT(SaidOf(huge), testing::StartsWith("packet 0: invalid packet capture length"));
  // pcapng counts in 64 bits; the fuzzer found this time of 4.6e12 s.
  EXPECT_EQ(SaidOf(ReadFileWhole(RAILCAST_SOURCE_DIR
                                 "/tests/fuzz/corpus/velodyne/capture_ng_in_far_future")
                       .substr(1)),
            "packet 0: must be captured before the year 2262 (got 4611686018427 s since 1970)");
  EXPECT_EQ(ReadAll("/no/such/place/a.pcap"), "/no/such/place/a.pcap: no such file or directory");
}

}  // namespace
}  // namespace railcast
