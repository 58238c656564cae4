#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "core/io/write_file.h"
#include "railcast/io/recording.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/captures.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/made_datagrams.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

constexpr std::size_t kMostMerged = 46;  // The most datagrams of 1400 bytes in one GSO call.

/// Returns the same bytes as a capture on the sending machine shows them under UDP segmentation
/// offload: neighbours of equal size are merged into one datagram. Every third run is left single,
/// as between the bursts of a live stream.
Datagrams Merged(const Datagrams& datagrams, std::size_t most = kMostMerged) {
  Datagrams merged{.bytes = datagrams.bytes, .items = {}};
  std::size_t in_run = most;
  for (const Datagrams::Item& item : datagrams.items) {
    const bool is_next = in_run < most && !merged.items.empty() &&
                         item.port == merged.items.back().port &&
                         item.offset == merged.items.back().offset + merged.items.back().size;
    if (is_next) {
      merged.items.back().size = static_cast<std::uint16_t>(merged.items.back().size + item.size);
      ++in_run;
    } else {
      merged.items.push_back(item);
      in_run = merged.items.size() % 3 == 0 ? most : 1;
    }
  }
  return merged;
}

class MergedCapture : public testing::TestWithParam<const char*> {};

TEST_P(MergedCapture, GivesTheFramesOfTheUnmergedOne) {
  const std::string_view format = GetParam();
  const MadeScan scan(ReadSensor(std::string(SensorOf(format))));
  const std::uint32_t returns = format == "vlp16-dual" ? 2 : 1;
  const Datagrams datagrams =
      EncodeAll(format, scan, {scan.MakeFrame(0, returns), scan.MakeFrame(1, returns)});
  const Datagrams merged = Merged(datagrams);
  ASSERT_LT(merged.items.size(), datagrams.items.size() / 10);
  const TemporaryDirectory directory;
  const auto whole = ReadAll(WriteDatagrams(directory.path() / "whole.pcap", datagrams));
  const auto cut = ReadAll(WriteDatagrams(directory.path() / "merged.pcap", merged));
  ASSERT_EQ(cut.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_TRUE(FrameBytes(cut[i].frame) == FrameBytes(whole[i].frame)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(CaptureRecording,
                         MergedCapture,
                         testing::Values("vlp16", "vlp16-dual", "hdl32e", "vlp32c", "vls128"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

/// Returns `count` packets of a Pandar64, one after the other.
Datagrams PandarPackets(std::size_t count) {
  Datagrams datagrams;
  for (std::uint32_t i = 0; i < count; ++i) {
    AddDatagram(NumberedPacket(i), datagrams);
  }
  return datagrams;
}

TEST(CaptureRecording, OfAMergedPandar64GivesEveryTurn) {
  const TemporaryDirectory directory;
  const Datagrams datagrams = PandarPackets(100);
  const auto frames = ReadAll(WriteDatagrams(directory.path() / "a.pcap", Merged(datagrams)));
  // Each made packet begins at the azimuth of the one before it and is therefore a turn of its own,
  // of six cycles.
  ASSERT_EQ(frames.size(), 100U);
  for (const RecordedFrame& frame : frames) EXPECT_EQ(frame.frame.columns, 6U);
}

TEST(CaptureRecording, LeavesOutAMergedDatagramThatEndsWithinAPacket) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  Datagrams datagrams = Merged(PandarPackets(100));
  const std::size_t num_merged = datagrams.items[1].size / 1198U;
  datagrams.items[1].size = 3 * 1198 + 500;
  const auto recording = OpenRecording(WriteDatagrams(file, datagrams));
  EXPECT_EQ(ReadAll(*recording).size(), 100U - num_merged);
  const auto remarks = recording->info().remarks->List();
  const auto refused = std::ranges::find(remarks, RemarkKind::kPacketsRefused, &Remark::kind);
  ASSERT_NE(refused, remarks.end());
  EXPECT_EQ(refused->Text(),
            "3 packets of the sensor that cannot be read: must be whole packets of 1198 bytes (got "
            "4094) (the first in " +
                file.string() + ": packet 1)");
}

TEST(CaptureRecording, RefusesAMergedDatagramThatTheCaptureCut) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  WriteDatagrams(file, Merged(PandarPackets(100)));
  // Cut the first packet as "tcpdump -s 1500" would.
  std::string bytes = ReadFileWhole(file);
  constexpr std::size_t kFileHeader = 24;
  constexpr std::size_t kPacketHeader = 16;
  const std::uint32_t kept = 1500;
  std::memcpy(bytes.data() + kFileHeader + 8, &kept, sizeof kept);
  WriteFileWhole(file, bytes.substr(0, kFileHeader + kPacketHeader + kept));
  EXPECT_EQ(MessageOf([&] { static_cast<void>(ReadAll(file)); }),
            file.string() + ": packet 0: must be captured whole (got 1500 of 55150 bytes)");
}

}  // namespace
}  // namespace railcast
