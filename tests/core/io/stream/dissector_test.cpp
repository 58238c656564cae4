#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "tests/core/io/stream/stream_example.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

using testing::HasSubstr;

template <typename T>
void Append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::uint16_t BigEndian(std::size_t value) {
  return static_cast<std::uint16_t>((value & 0xFFU) << 8U | value >> 8U);
}

// Returns a capture file of UDP datagrams that start at an IPv4 header (link type 101), of each of
// which the capture kept `kept` bytes.
std::string Capture(const std::vector<std::string>& datagrams,
                    std::uint16_t port,
                    std::size_t kept) {
  std::string bytes;
  for (const std::uint32_t word : {0xA1B2C3D4U, 4U << 16U | 2U, 0U, 0U, 65'535U, 101U}) {
    Append(bytes, word);
  }
  for (const std::string& datagram : datagrams) {
    const std::size_t size = 28 + datagram.size();
    const std::size_t kept_size = 28 + std::min(kept, datagram.size());
    for (const std::size_t word : {std::size_t{0}, std::size_t{0}, kept_size, size}) {
      Append(bytes, static_cast<std::uint32_t>(word));
    }
    Append(bytes, std::uint16_t{0x45});
    for (const std::size_t half :
         {size, std::size_t{0}, std::size_t{0}, std::size_t{0x4011}, std::size_t{0}}) {
      Append(bytes, BigEndian(half));
    }
    for (int address = 0; address < 2; ++address) Append(bytes, std::uint32_t{0x0100007F});
    for (const std::size_t half :
         {std::size_t{50'000}, std::size_t{port}, 8 + datagram.size(), std::size_t{0}}) {
      Append(bytes, BigEndian(half));
    }
    bytes += datagram.substr(0, kept);
  }
  return bytes;
}

class Dissector : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasTshark()) GTEST_SKIP() << "tshark is missing";
  }

  /// Returns the output of tshark for these datagrams.
  static std::string Show(const std::vector<std::string>& datagrams,
                          const std::string& arguments,
                          std::uint16_t port = 27'400,
                          std::size_t kept = 65'535) {
    const TemporaryDirectory directory;
    const std::string file = directory.path() / "capture.pcap";
    WriteFileWhole(file, Capture(datagrams, port, kept));
    const Ended run =
        RunCommand("tshark -X lua_script:" RAILCAST_SOURCE_DIR "/scripts/railcast.lua -r " + file +
                   " " + arguments + " 2>" + (directory.path() / "errors").string());
    EXPECT_EQ(run.status, 0) << ReadFileWhole(directory.path() / "errors");
    EXPECT_THAT(run.said, testing::Not(HasSubstr("Lua Error")));
    return run.said;
  }
};

TEST_F(Dissector, ReadsEveryMemberOfTheHeader) {
  StreamSpec spec;
  spec.run = 3;
  spec.sensor = 7;
  const Frame frame = StreamFrame(12);
  const auto datagrams = DatagramsOf(frame, spec);
  const std::string said =
      Show({datagrams[1]},
           "-T fields -E separator=, -e railcast.magic -e railcast.version -e railcast.flags "
           "-e railcast.header_size -e railcast.run -e railcast.sensor -e railcast.points "
           "-e railcast.frame -e railcast.packet -e railcast.packets -e railcast.stamp_ns "
           "-e railcast.duration_ns -e railcast.frame_points -e railcast.first_point "
           "-e railcast.rows -e railcast.columns -e railcast.returns -e railcast.point_size "
           "-e railcast.pose.x -e railcast.end_pose.z -e railcast.fields -e railcast.crc.status");
  EXPECT_EQ(said,
            "RCST,1,0x00,222,3,7,39,12,1,25,1200000000,239950000,960,39,16,300,1,30,5300001.2,"
            "412.25,8,good\n");
}

TEST_F(Dissector, ShowsTheFirstPointsByTheirFields) {
  const Frame frame = StreamFrame(0);
  const ReceivedFrame whole = ReceiveWhole(frame);
  const std::string said = Show({DatagramsOf(frame)[0]}, "-O railcast");
  EXPECT_THAT(said, HasSubstr("intensity: f32\n"));
  EXPECT_THAT(said, HasSubstr("Point 9\n"));
  EXPECT_THAT(said, testing::Not(HasSubstr("Point 10\n")));
  std::ostringstream time;
  time << "time_ns u32: " << whole.At<std::uint32_t>(*whole.header.Find("time_ns"), 9) << "\n";
  EXPECT_THAT(said, HasSubstr(time.str()));
}

TEST_F(Dissector, SaysWhetherTheChecksumIsRight) {
  const std::string sound = DatagramsOf(StreamFrame(0)).front();
  std::string damaged = sound;
  damaged[500] = static_cast<char>(damaged[500] ^ 1);
  EXPECT_EQ(Show({sound, damaged}, "-T fields -e railcast.crc.status"), "good\nbad\n");
  EXPECT_THAT(Show({damaged}, ""), HasSubstr("CRC wrong"));
}

TEST_F(Dissector, KnowsItsDatagramsAtAnyPort) {
  const auto datagrams = DatagramsOf(StreamFrame(0));
  EXPECT_EQ(Show({datagrams[0], "hello"}, "-T fields -e railcast.frame_points", 12'345), "960\n\n");
}

// On the sending machine a capture shows datagrams that were sent in one call as one datagram of up
// to 65 kB.
TEST_F(Dissector, CutsWhatSegmentationOffloadMerged) {
  const std::vector<std::string> all = DatagramsOf(StreamFrame(0));
  ASSERT_EQ(all.size(), 25U);
  std::string merged;
  std::string packets;
  std::string statuses;
  for (std::size_t i = 0; i < all.size(); ++i) {
    merged += all[i];
    packets += (i == 0 ? "" : ",") + std::to_string(i);
    statuses += i == 0 ? "good" : ",good";
  }
  // The last datagram is the shortest.
  ASSERT_LT(all.back().size(), all.front().size());
  EXPECT_EQ(
      Show({merged, all[3]}, "-T fields -E separator=/s -e railcast.packet -e railcast.crc.status"),
      packets + " " + statuses + "\n3 good\n");
  const std::string said = Show({merged}, "");
  EXPECT_THAT(said, HasSubstr("25 datagrams in one, the first: Run 0, frame 0, packet 0 of 25"));
  EXPECT_THAT(said, testing::Not(HasSubstr("CRC wrong")));
  std::string damaged = merged;
  damaged[all[0].size() + 500] = static_cast<char>(damaged[all[0].size() + 500] ^ 1);
  EXPECT_THAT(Show({damaged}, "-T fields -e railcast.crc.status"), HasSubstr("good,bad,good,"));
}

TEST_F(Dissector, SaysWhatTheCaptureCutInsteadOfCallingItDamaged) {
  const std::vector<std::string> all = DatagramsOf(StreamFrame(0));
  const std::size_t kept = all[0].size() + all[1].size() - 100;
  EXPECT_EQ(Show({all[0] + all[1]}, "-T fields -e railcast.crc.status", 27'400, kept),
            "good,cut\n");
  EXPECT_THAT(Show({all[0] + all[1]}, "", 27'400, kept), HasSubstr("[not captured whole]"));
}

TEST_F(Dissector, SurvivesDatagramsThatContradictThemselves) {
  const std::string sound = DatagramsOf(StreamFrame(0)).front();
  const std::vector<std::string> hostile = {
      sound.substr(0, 100),
      sound.substr(0, 180),
      With<std::uint16_t>(sound, 6, 65'535),
      With<std::uint16_t>(sound, 14, 65'535),
      With<std::uint16_t>(sound, 54, 0),
      With<std::uint16_t>(sound, 168, 65'535),
      With<std::uint8_t>(sound, 170, 99),
      With<std::uint8_t>(sound, 171, 255),
  };
  const std::string said = Show(hostile, "-T fields -e railcast.malformed");
  EXPECT_EQ(std::ranges::count(said, '\n'), 8);
  const std::string detail = Show(hostile, "-O railcast");
  std::size_t num_found = 0;
  for (std::size_t at = 0;
       (at = detail.find("Expert Info (Error/Malformed)", at)) != std::string::npos;) {
    ++num_found;
    ++at;
  }
  EXPECT_EQ(num_found, 7U) << "all but the one that is too short for a header";
}

}  // namespace
}  // namespace railcast
