#include "generator/extras/insert/packets/packet_outputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/pcap/pcap_writer.h"
#include "core/extras/packets/recording/capture_sensor.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/packets/same_copy.h"
#include "tests/core/extras/packets/hesai/sent_turns.h"
#include "tests/core/extras/packets/ouster/shared_captures.h"
#include "tests/core/extras/packets/pcap/made_capture.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/packets/frame_edits.h"
#include "tests/generator/extras/insert/packets/hand_edits.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Expects two captures to differ in nothing but bytes of UDP's payloads and checksums.
void ExpectSameCapture(const fs::path& source, const fs::path& copy) {
  const std::string before = ReadFileWhole(source);
  std::string after = ReadFileWhole(copy);
  ASSERT_EQ(after.size(), before.size());
  PcapReader reader(source);
  reader.FindPlaces();
  while (const auto datagram = reader.Next()) {
    for (const CapturedPiece& piece : datagram->pieces) {
      after.replace(piece.place, piece.size, before, piece.place, piece.size);
    }
  }
  EXPECT_TRUE(after == before);
}

/// Copies a capture without edits and with edits of all kinds.
void ExpectEditsOf(const fs::path& source) {
  const TemporaryDirectory folder;
  const fs::path same = folder.path() / "same" / source.filename();
  const fs::path edited = folder.path() / "edited" / source.filename();
  static_cast<void>(CopyWithEdits(source, same.parent_path(), WithoutEdits));
  EXPECT_TRUE(ReadFileWhole(same) == ReadFileWhole(source));
  const auto frames = CopyWithEdits(source, edited.parent_path(), EditedByHand);
  ExpectSameCapture(source, edited);
  const auto recording = OpenRecording(edited);
  const auto read = ReadAll(*recording);
  ASSERT_EQ(read.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_FALSE(frames[i].edits.empty());
    ExpectEdits(frames[i], read[i]);
  }
  // As many packets have a wrong checksum as before.
  const auto original = OpenRecording(source);
  static_cast<void>(ReadAll(*original));
  const auto remarks = recording->info().remarks->List();
  const auto before = original->info().remarks->List();
  ASSERT_EQ(remarks.size(), before.size());
  for (std::size_t i = 0; i < remarks.size(); ++i) {
    EXPECT_EQ(remarks[i].kind, before[i].kind);
    EXPECT_EQ(remarks[i].number, before[i].number);
  }
}

class RealCaptureCopies : public testing::TestWithParam<std::string> {};

TEST_P(RealCaptureCopies, DecodeToTheEditsAlone) {
  const fs::path source = OusterCapture::Path(GetParam().c_str());
  if (!exists(source)) GTEST_SKIP() << source << " is not there";
  ExpectEditsOf(source);
}

std::vector<std::string> RealCaptures() {
  std::vector<std::string> captures;
  for (const char* name : {"pandar64", "vlp16_dual", "vlp32c_single", "vls128_single"}) {
    captures.push_back("lidar_packets_nebula/" + std::string(name) + ".pcap");
  }
  for (const OusterCapture& capture : kOusterCaptures) captures.emplace_back(capture.pcap);
  return captures;
}

INSTANTIATE_TEST_SUITE_P(All,
                         RealCaptureCopies,
                         testing::ValuesIn(RealCaptures()),
                         [](const auto& test) { return "Number" + std::to_string(test.index); });

/// Writes datagrams to a capture.
fs::path Captured(const Datagrams& datagrams, const fs::path& file, bool is_ipv6 = false) {
  PcapWriter writer(file, 2368, 8308, is_ipv6);
  writer.Write(datagrams, datagrams.items);
  writer.Finish();
  return file;
}

Datagrams HesaiPackets(const SentAs& sending) {
  const SpinningModel& model = *FindSpinningModel(sending.protocol);
  const MadeScan scan(ReadSensor(FileOf(model)));
  const std::uint32_t returns = sending.mode == ReturnMode::kDual ? 2 : 1;
  return Encoded(model, scan, {scan.MakeFrame(0, returns), scan.MakeFrame(1, returns)},
                 sending.mode);
}

Datagrams VelodynePackets(const std::string& format) {
  const MadeScan scan(ReadSensor(std::string(SensorOf(format))));
  const ReturnMode mode = ReturnModeOfFormat(format);
  const auto encoder = MakeSpinningEncoder(*FindSpinningModel(format), scan.spec(), mode);
  Datagrams datagrams;
  for (const std::uint32_t i : {0U, 1U}) {
    encoder->Encode(scan.MakeFrame(i, mode == ReturnMode::kDual ? 2 : 1), datagrams);
  }
  return datagrams;
}

class HesaiCaptureCopies : public testing::TestWithParam<SentAs> {};

TEST_P(HesaiCaptureCopies, DecodeToTheEditsAlone) {
  const TemporaryDirectory folder;
  ExpectEditsOf(Captured(HesaiPackets(GetParam()), folder.path() / "sent.pcap"));
}

INSTANTIATE_TEST_SUITE_P(All, HesaiCaptureCopies, testing::ValuesIn(Sendings()));

class VelodyneCaptureCopies : public testing::TestWithParam<const char*> {};

TEST_P(VelodyneCaptureCopies, DecodeToTheEditsAlone) {
  const TemporaryDirectory folder;
  ExpectEditsOf(Captured(VelodynePackets(GetParam()), folder.path() / "sent.pcap"));
}

INSTANTIATE_TEST_SUITE_P(All,
                         VelodyneCaptureCopies,
                         testing::Values("vlp16", "vlp16-dual", "hdl32e", "vlp32c", "vls128"));

/// The sum of RFC 1071 of a UDP datagram over IPv6, as PcapWriter frames it, with its checksum.
std::uint32_t UdpSumOf(const std::string& file, const CapturedPiece& udp) {
  constexpr std::size_t kAddresses = 32;
  std::uint32_t sum = 17 + static_cast<std::uint32_t>(udp.size);
  for (std::size_t i = udp.place - kAddresses; i < udp.place + udp.size; ++i) {
    const auto byte = static_cast<unsigned char>(file[i]);
    sum += (i - udp.place + kAddresses) % 2 == 0 ? byte * 256U : byte;
  }
  while (sum >> 16U != 0) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return sum;
}

// PcapWriter writes checksums with IPv6.
TEST(CaptureOutput, KeepsChecksumsOfUdpRight) {
  const TemporaryDirectory folder;
  const fs::path source =
      Captured(VelodynePackets("vlp16-dual"), folder.path() / "sent.pcap", true);
  static_cast<void>(CopyWithEdits(source, folder.path() / "edited", EditedByHand));
  const std::string before = ReadFileWhole(source);
  const std::string after = ReadFileWhole(folder.path() / "edited/sent.pcap");
  PcapReader reader(source);
  reader.FindPlaces();
  std::size_t num_changed = 0;
  while (const auto datagram = reader.Next()) {
    const CapturedPiece udp = datagram->pieces.front();
    num_changed += before.compare(udp.place, udp.size, after, udp.place, udp.size) != 0 ? 1 : 0;
    ASSERT_EQ(UdpSumOf(before, udp), 0xFFFFU);
    ASSERT_EQ(UdpSumOf(after, udp), 0xFFFFU);
  }
  EXPECT_GT(num_changed, 100U);
}

TEST(CaptureOutput, LeavesNoUnfinishedCopyWhereARunEndsEarly) {
  const TemporaryDirectory folder;
  const fs::path source = Captured(VelodynePackets("vlp16"), folder.path() / "sent.pcap");
  const fs::path copies = folder.path() / "recording";
  {
    const auto output = MakeSameCopy(OpenRecording(source)->info(), copies);
    EXPECT_EQ(output->Begin(0), 0U);
    EXPECT_TRUE(exists(copies / "sent.pcap.part"));
  }
  EXPECT_TRUE(fs::is_empty(copies));
  const auto output = MakeSameCopy(OpenRecording(source)->info(), copies);
  EXPECT_EQ(output->Begin(0), 0U);
  output->Finish();
  EXPECT_TRUE(ReadFileWhole(copies / "sent.pcap") == ReadFileWhole(source));
}

TEST(CaptureOutput, LeavesAnAbsentChecksumAbsentAndNeverMakesOneSo) {
  EXPECT_EQ(ChangedChecksum(0, 8, std::array{'a'}, std::array{'b'}), 0);
  // 0xFFFE + 1 = 0xFFFF, whose complement would be the 0 that stands for none.
  EXPECT_EQ(ChangedChecksum(1, 9, std::array{'\0'}, std::array{'\1'}), 0xFFFF);
  EXPECT_EQ(ChangedChecksum(0xFFFF, 8, std::array{'\0'}, std::array{'\1'}), 0xFEFF);
}

/// The payloads of a capture.
std::vector<std::string> PayloadsIn(const fs::path& file) {
  PcapReader reader(file);
  std::vector<std::string> payloads;
  while (const auto datagram = reader.Next()) {
    payloads.emplace_back(datagram->payload.begin(), datagram->payload.end());
  }
  return payloads;
}

// As captures of Ouster's packets are; the pieces of two datagrams alternate here.
TEST(CaptureOutput, FindsWhatWasSentInIpFragments) {
  const TemporaryDirectory folder;
  const auto payloads =
      PayloadsIn(Captured(VelodynePackets("vlp32c"), folder.path() / "sent.pcap"));
  std::vector<CapturedFrame> frames;
  for (std::size_t i = 0; i + 1 < payloads.size(); i += 2) {
    for (const std::size_t begin : {std::size_t{608}, std::size_t{0}}) {
      for (const std::size_t k : {i, i + 1}) {
        frames.push_back(
            {FragmentOf(Udp(payloads[k]), begin, begin == 0 ? 608 : 606, k), 1000 * i});
      }
    }
  }
  ExpectEditsOf(WriteCapture(folder.path() / "pieces.pcap", frames));
}

TEST(CaptureOutput, EditsEachCopyOfAPacketAndLeavesOtherSensorsAsTheyAre) {
  const TemporaryDirectory folder;
  const auto mine = PayloadsIn(Captured(VelodynePackets("vlp16"), folder.path() / "a.pcap"));
  const auto others = PayloadsIn(Captured(VelodynePackets("hdl32e"), folder.path() / "b.pcap"));
  // As `tcpdump -i any` writes them, in pairs that were exchanged and with most of them twice.
  const std::string sll("\0\0\0\1\0\6\1\2\3\4\5\6\0\0\x08\0", 16);
  std::vector<CapturedFrame> frames;
  for (std::size_t i = 0; i + 1 < mine.size(); ++i) {
    frames.push_back({sll + IpOf(mine[i ^ 1U]), 1000 * i});
    frames.push_back({sll + IpOf(others[i], '\xCA'), 1000 * i});
    if (i >= 5) frames.push_back({sll + IpOf(mine[i - 5]), 1000 * i});
  }
  const fs::path source = WriteCapture(folder.path() / "c.pcap", frames, 113);
  const std::string sensor = ":192.168.1.201";
  const auto inserted =
      CopyWithEdits(source.string() + sensor, folder.path() / "edited", EditedByHand);
  const fs::path edited = folder.path() / "edited/c.pcap";
  ExpectSameCapture(source, edited);
  const auto read = ReadAll(edited.string() + sensor);
  ASSERT_EQ(read.size(), inserted.size());
  for (std::size_t i = 0; i < read.size(); ++i) ExpectEdits(inserted[i], read[i]);
  const auto before = PayloadsIn(source);
  const auto after = PayloadsIn(edited);
  std::map<std::string, std::string> edits;
  std::size_t num_edited = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(edits.try_emplace(before[i], after[i]).first->second, after[i]) << i;
    if (std::ranges::count(others, before[i]) > 0) {
      EXPECT_TRUE(after[i] == before[i]);
    }
    num_edited += after[i] == before[i] ? 0 : 1;
  }
  EXPECT_GT(num_edited, 2 * mine.size() - 20);
}

/// A capture as pcapng: a section in either byte order, with enhanced packet blocks that have
/// options behind them, and simple ones.
std::string Pcapng(const std::vector<std::string>& frames, bool is_big) {
  const auto number = [&](std::uint32_t value, std::size_t size) {
    std::string bytes(reinterpret_cast<const char*>(&value), size);
    if (is_big) std::ranges::reverse(bytes);
    return bytes;
  };
  const auto block = [&](std::uint32_t type, std::string body) {
    body.resize((body.size() + 3) / 4 * 4);
    const auto size = static_cast<std::uint32_t>(body.size() + 12);
    return number(type, 4) + number(size, 4) + body + number(size, 4);
  };
  std::string file = block(0x0A0D0D0A, number(0x1A2B3C4D, 4) + number(1, 2) + number(0, 2) +
                                           std::string(8, '\xFF')) +
                     block(1, number(1, 2) + number(0, 2) + number(0, 4));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto size = static_cast<std::uint32_t>(frames[i].size());
    std::string padded = frames[i];
    padded.resize((padded.size() + 3) / 4 * 4);
    const std::string comment = number(1, 2) + number(4, 2) + "note" + number(0, 4);
    file += i % 5 == 4
                ? block(3, number(size, 4) + padded)
                : block(6, number(0, 4) + number(0, 4) + number(static_cast<std::uint32_t>(i), 4) +
                               number(size, 4) + number(size, 4) + padded + comment);
    if (i % 7 == 0) file += block(5, number(0, 4) + number(0, 4) + number(0, 4));
  }
  return file;
}

TEST(CaptureOutput, EditsPcapngInBothByteOrders) {
  const TemporaryDirectory folder;
  std::vector<std::string> frames;
  for (const std::string& payload :
       PayloadsIn(Captured(VelodynePackets("vlp16"), folder.path() / "sent.pcap"))) {
    frames.push_back(FragmentOf(Udp(payload), 0, payload.size() + 8));
  }
  for (const bool is_big : {false, true}) {
    const fs::path file = folder.path() / (is_big ? "big.pcapng" : "little.pcapng");
    WriteFileWhole(file, Pcapng(frames, is_big));
    ExpectEditsOf(file);
  }
}

// Segmentation offload merges packets; other traffic and damaged packets stand between them.
TEST(CaptureOutput, EditsMergedPacketsAmongOthers) {
  const TemporaryDirectory folder;
  auto payloads = PayloadsIn(Captured(HesaiPackets({"pandar128e4x", ReturnMode::kStrongest}),
                                      folder.path() / "sent.pcap"));
  std::vector<CapturedFrame> frames;
  const auto add = [&](const std::string& payload) {
    frames.push_back({FragmentOf(Udp(payload), 0, payload.size() + 8), frames.size()});
  };
  for (std::size_t i = 0; i + 2 < payloads.size(); i += 3) {
    add(payloads[i] + payloads[i + 1]);
    add("other traffic");
    // A checksum is wrong from here on.
    if (i % 30 == 0) payloads[i + 2][200] = static_cast<char>(payloads[i + 2][200] ^ 1);
    add(payloads[i + 2]);
  }
  ExpectEditsOf(WriteCapture(folder.path() / "merged.pcap", frames));
}

TEST(CaptureOutput, PutsTheFartherOfTwoReturnsFirst) {
  const TemporaryDirectory folder;
  const fs::path source = Captured(VelodynePackets("vlp16-dual"), folder.path() / "sent.pcap");
  const auto add_both = [](const RecordedFrame& recorded) {
    HandEdit edit(recorded);
    edit.Add(100, 10.0F, 0.1F);
    edit.Add(101, 20.0F, 0.2F);
    return edit.Take();
  };
  static_cast<void>(CopyWithEdits(source, folder.path() / "edited", add_both));
  for (const RecordedFrame& read : ReadAll(folder.path() / "edited/sent.pcap")) {
    EXPECT_NEAR(read.frame.range_m[100], 20.0F, 0.001F);
    EXPECT_NEAR(read.frame.range_m[101], 10.0F, 0.001F);
    EXPECT_EQ(read.frame.intensity[101], 0.1F);
  }
}

TEST(CaptureOutput, RefusesWhatPacketsCannotState) {
  const TemporaryDirectory folder;
  const fs::path source = Captured(VelodynePackets("vlp16"), folder.path() / "sent.pcap");
  const auto add_far = [](const RecordedFrame& recorded) {
    HandEdit edit(recorded);
    edit.Add(5, 150.0F, 0.1F);
    return edit.Take();
  };
  EXPECT_EQ(MessageOf([&] {
              static_cast<void>(CopyWithEdits(source, folder.path() / "edited", add_far));
            }),
            source.string() + ": turn 0: range must be 0.002 to 131.07 m in packets (got 150)");
  // Nothing has the capture's name before it is finished.
  EXPECT_FALSE(exists(folder.path() / "edited/sent.pcap"));
}

// Whatever byte is damaged: a copy of the same size, or one line.
TEST(CaptureOutput, OfDamagedCapturesIsMadeOrRefusedWithALine) {
  const TemporaryDirectory folder;
  std::vector<CapturedFrame> frames;
  for (const std::string& payload :
       PayloadsIn(Captured(VelodynePackets("vlp16-dual"), folder.path() / "sent.pcap"))) {
    if (frames.size() < 40) frames.push_back({FragmentOf(Udp(payload), 0, payload.size() + 8), 0});
  }
  const std::string whole = ReadFileWhole(WriteCapture(folder.path() / "whole.pcap", frames));
  std::size_t num_copied = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    std::string damaged = whole;
    // Densely in the first packet's headers, and here and there behind them.
    const std::size_t place = i < 120 ? i : 120 + 127 * i % (whole.size() - 120);
    damaged[place] = static_cast<char>(damaged[place] ^ (1 << i % 8));
    WriteFileWhole(folder.path() / "damaged.pcap", damaged);
    try {
      static_cast<void>(
          CopyWithEdits(folder.path() / "damaged.pcap", folder.path() / "out", EditedByHand));
      EXPECT_EQ(ReadFileWhole(folder.path() / "out/damaged.pcap").size(), damaged.size());
      ++num_copied;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(num_copied, 200U);
  EXPECT_LT(num_copied, 400U);
}

// Frames before the first and after the last that are wanted stay as they are.
TEST(CaptureOutput, LeavesFramesThatItIsNotGiven) {
  const TemporaryDirectory folder;
  const fs::path source = OusterCapture::Path("lidar_packets_nebula/vlp16_dual.pcap");
  if (!exists(source)) GTEST_SKIP() << source << " is not there";
  const auto frames = ReadAll(source);
  ASSERT_GT(frames.size(), 2U);
  const auto output = MakeCopyOutput(source, folder.path());
  RecordedFirings firings;
  firings.recorded = frames[1];
  const InsertedFrame edited = EditedByHand(frames[1]);
  output->Write(firings, edited);
  output->Finish();
  const auto read = ReadAll(folder.path() / source.filename());
  ASSERT_EQ(read.size(), frames.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    ExpectEdits(i == 1 ? edited : WithoutEdits(frames[i]), read[i]);
  }
}

}  // namespace
}  // namespace railcast
