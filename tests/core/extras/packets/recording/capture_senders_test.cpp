#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/packets/recording/capture_sensor.h"
#include "core/extras/packets/recording/turn_reader.h"
#include "core/io/recording/source_choice.h"
#include "core/io/write_file.h"
#include "tests/core/extras/packets/ouster/made_ouster.h"
#include "tests/core/extras/packets/pcap/made_capture.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/made_datagrams.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

std::vector<std::string> PacketsOf(const char* format, std::uint32_t first_frame = 0) {
  const MadeScan scan(ReadSensor(format));
  return DataTexts(
      EncodeAll(format, scan, {scan.MakeFrame(first_frame), scan.MakeFrame(first_frame + 1)}));
}

/// What a sensor sends, and from where.
struct Sent {
  std::vector<std::string> packets;
  char host = '\xC9';
  std::size_t from = 2368;
  std::size_t to = 2368;
};

/// Writes a capture in which the sensors take turns.
std::filesystem::path WriteSent(const std::filesystem::path& file, const std::vector<Sent>& all) {
  std::vector<CapturedFrame> frames;
  std::size_t most = 0;
  for (const Sent& sent : all) most = std::max(most, sent.packets.size());
  for (std::size_t i = 0; i < most; ++i) {
    for (const auto& [packets, host, from, to] : all) {
      if (i >= packets.size()) continue;
      frames.push_back({EthernetOf(IpOf(packets[i], host, from, to)), 1000 * frames.size()});
    }
  }
  return WriteCapture(file, frames);
}

void ExpectSameFrames(const std::filesystem::path& got, const std::filesystem::path& expected) {
  const auto frames = ReadAll(got);
  const auto others = ReadAll(expected);
  ASSERT_EQ(frames.size(), others.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_TRUE(FrameBytes(frames[i].frame) == FrameBytes(others[i].frame)) << i;
  }
}

std::string FaultOfCapture(const std::filesystem::path& source) {
  return MessageOf([&] { static_cast<void>(OpenRecording(source)); });
}

TEST(CaptureSenders, AreNamedUntilOneIsChosen) {
  const TemporaryDirectory folder;
  const Sent roof{PacketsOf("vlp16")};
  const Sent front{PacketsOf("vlp16", 5), '\xCA'};
  const Sent rear{PacketsOf("hdl32e"), '\xCB'};
  const std::string file = WriteSent(folder.path() / "a.pcap", {roof, front, rear}).string();
  const std::string holds =
      ": holds 3 sensors: VLP-16 at 192.168.1.201, VLP-16 at 192.168.1.202, HDL-32E at "
      "192.168.1.203; ";
  EXPECT_EQ(FaultOfCapture(file), file + holds + "--sensor picks one");
  EXPECT_EQ(FaultOfCapture(file + ":192.168.1.9"),
            file + ":192.168.1.9" + holds + "must be one of them (got 192.168.1.9)");
  ExpectSameFrames(file + ":192.168.1.202", WriteSent(folder.path() / "b.pcap", {front}));
  ExpectSameFrames(file + ":192.168.1.203:2368", WriteSent(folder.path() / "c.pcap", {rear}));
  const auto recording = OpenRecording(file + ":192.168.1.201");
  static_cast<void>(ReadAll(*recording));
  const auto remarks = recording->info().remarks->List();
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].kind, RemarkKind::kOtherSenders);
  EXPECT_EQ(remarks[0].number, front.packets.size() + rear.packets.size());
}

TEST(CaptureSenders, OfLegacyOusterPacketsNeedTheNameOfTheirMetadata) {
  const TemporaryDirectory folder;
  const std::string text = MadeOusterMetadataText("LEGACY");
  const auto packets = DataTexts(MadeOuster(text).Encode({0, 1}));
  const std::string file =
      WriteSent(folder.path() / "a.pcap", {{packets}, {packets, '\xCA'}}).string();
  const std::string metadata = (folder.path() / "a.json").string();
  WriteFileWhole(metadata, text);
  EXPECT_THAT(FaultOfCapture(file + ":192.168.1.202"),
              testing::EndsWith("; their packets do not say whose metadata " + metadata +
                                " has: CAPTURE:METADATA:ADDRESS does"));
  EXPECT_EQ(FaultOfCapture(file + ":" + metadata + ":192.168.1.202"), "no error");
}

TEST(CaptureSenders, AtOneAddressAreToldByTheirPorts) {
  const TemporaryDirectory folder;
  const Sent left{PacketsOf("vlp16"), '\xC9', 5001, 2368};
  const Sent right{PacketsOf("vlp16", 5), '\xC9', 5002, 2368};
  const std::string file = WriteSent(folder.path() / "a.pcap", {left, right}).string();
  EXPECT_EQ(FaultOfCapture(file),
            file + ": holds 2 sensors: VLP-16 at 192.168.1.201:5001, VLP-16 at " +
                "192.168.1.201:5002; --sensor picks one");
  ExpectSameFrames(file + ":192.168.1.201:5002", WriteSent(folder.path() / "b.pcap", {right}));
  // From one port, they are told by where they send to.
  const Sent other{right.packets, '\xC9', 5001, 2369};
  const std::string both = WriteSent(folder.path() / "c.pcap", {left, other}).string();
  EXPECT_EQ(FaultOfCapture(both),
            both + ": holds 2 sensors: VLP-16 at 192.168.1.201:2368, VLP-16 at " +
                "192.168.1.201:2369; --sensor picks one");
  ExpectSameFrames(both + ":192.168.1.201:2369", WriteSent(folder.path() / "b.pcap", {right}));
}

TEST(CaptureSenders, ThatSendToTwoPortsAreOne) {
  const TemporaryDirectory folder;
  const Sent one{PacketsOf("vlp16")};
  const Sent copy{one.packets, '\xC9', 2368, 2370};
  const auto file = WriteSent(folder.path() / "a.pcap", {one, copy});
  ExpectSameFrames(file, WriteSent(folder.path() / "b.pcap", {one}));
  const std::vector<TurnReader> readers = CountPackets(*FindCapture(file));
  ASSERT_EQ(readers.size(), 1U);
  EXPECT_EQ(PortsText(readers[0].sensor()), "2368, 2370");
  EXPECT_EQ(readers[0].order().doubled().number, one.packets.size());
  EXPECT_EQ(readers[0].lost().number, 0U);
}

TEST(CaptureSenders, ThatSendToTwoInAnyOrderOrChangeTheReceiverAreOne) {
  const TemporaryDirectory folder;
  const auto packets = PacketsOf("vlp16");
  const auto plain = WriteSent(folder.path() / "plain.pcap", {{packets}});
  std::vector<CapturedFrame> mirrored;
  std::vector<CapturedFrame> changed;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    for (const bool is_first : {true, false}) {
      const std::size_t to = is_first == (i == 0) ? 2368 : 2370;
      mirrored.push_back({EthernetOf(IpOf(packets[i], '\xC9', 2368, to)), 1000 * i});
    }
    const std::size_t to = i >= 40 && i < 80 ? 2370 : 2368;
    changed.push_back({EthernetOf(IpOf(packets[i], '\xC9', 2368, to)), 1000 * i});
  }
  ExpectSameFrames(WriteCapture(folder.path() / "a.pcap", mirrored), plain);
  ExpectSameFrames(WriteCapture(folder.path() / "b.pcap", changed), plain);
}

TEST(CaptureSenders, AreChosenByTheirOwnPortFirst) {
  const TemporaryDirectory folder;
  const Sent left{PacketsOf("vlp16"), '\xC9', 2368, 2368};
  const Sent right{PacketsOf("vlp16", 5), '\xC9', 2369, 2368};
  const std::string file = WriteSent(folder.path() / "a.pcap", {left, right}).string();
  ExpectSameFrames(file + ":192.168.1.201:2368", WriteSent(folder.path() / "b.pcap", {left}));
  ExpectSameFrames(file + ":192.168.1.201:2369", WriteSent(folder.path() / "c.pcap", {right}));
}

TEST(CaptureSenders, AreWrittenAsAddresses) {
  EXPECT_EQ(EndpointText(*ParseSender("10.0.0.1:7502")), "10.0.0.1:7502");
  EXPECT_EQ(ParseSender("10.0.0.1")->port, 0);
  EXPECT_EQ(AddressText(ParseSender("fe80::1")->address), "fe80::1");
  EXPECT_EQ(ParseSender("[fe80::1]:2368")->port, 2368);
  for (const char* text : {"", "os.json", "10.0.0", "10.0.0.1:", "10.0.0.1:0", "10.0.0.1:70000",
                           "[fe80::1", "host:2368", ":2368"}) {
    EXPECT_FALSE(ParseSender(text)) << text;
  }
  const CaptureSuffix both = SplitCaptureSuffix("a:b/os.json:10.0.0.1:7502");
  EXPECT_EQ(both.metadata, "a:b/os.json");
  EXPECT_EQ(both.sensor, "10.0.0.1:7502");
  EXPECT_EQ(SplitCaptureSuffix("[fe80::1]:2368").sensor, "[fe80::1]:2368");
  EXPECT_EQ(SplitCaptureSuffix("os.json").metadata, "os.json");
}

TEST(WithChoice, NamesTheSensorOfCapturesAlone) {
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_EQ(WithChoice({"run", "a.pcap"}, {}), (Paths{"run", "a.pcap"}));
  EXPECT_EQ(WithChoice({"run", "a.pcap"}, {.sensor = "10.0.0.1:7502"}),
            (Paths{"run", "a.pcap:10.0.0.1:7502"}));
  EXPECT_EQ(MessageOf([] { (void)WithChoice({"run"}, {.sensor = "10.0.0.1"}); }),
            "--sensor: must come with a capture, .pcap or .pcapng (got run)");
  EXPECT_EQ(MessageOf([] { (void)WithChoice({"a.pcap"}, {.sensor = "roof"}); }),
            "--sensor: must be the ADDRESS or ADDRESS:PORT of a sensor, such as "
            "192.168.1.201:2368 (got roof)");
}

}  // namespace
}  // namespace railcast
