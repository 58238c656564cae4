#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "core/io/write_file.h"
#include "tests/core/io/stream/stream_example.h"

namespace railcast {
namespace {

// Returns the datagram that docs/results/stream_datagram.md spells out in lines of "offset hex
// bytes meaning".
std::string DatagramOfThePage() {
  const std::string page = ReadFileWhole(RAILCAST_SOURCE_DIR "/docs/results/stream_datagram.md");
  const std::size_t begin = page.find("```text\n") + 8;
  std::istringstream lines(page.substr(begin, page.find("```", begin) - begin));
  std::string bytes;
  for (std::string line; std::getline(lines, line);) {
    constexpr std::size_t kHexAt = 6;
    constexpr std::size_t kMeaningAt = kHexAt + 16 * 3;
    EXPECT_EQ(std::stoul(line.substr(0, 4)), bytes.size()) << line;
    std::istringstream hex(line.substr(kHexAt, kMeaningAt - kHexAt));
    for (std::string byte; hex >> byte;) {
      bytes.push_back(static_cast<char>(std::stoul(byte, nullptr, 16)));
    }
  }
  return bytes;
}

Frame FrameOfThePage() {
  Frame frame;
  frame.Resize(3, 1, 1);
  frame.index = 7;
  frame.stamp_ns = 700'000'000;
  frame.duration_ns = 2000;
  frame.world_from_sensor.translation() = Vector3(100.0, 20.0, 3.5);
  frame.world_from_sensor_end.translation() = Vector3(100.5, 20.0, 3.5);
  frame.x = {12.5F, 0.0F, 40.0F};
  frame.y = {-0.25F, 0.0F, 1.0F};
  frame.z = {-1.5F, 0.0F, 2.0F};
  frame.intensity = {0.5F, 0.0F, 0.125F};
  frame.time_ns = {0, 1000, 2000};
  frame.ring = {0, 1, 2};
  frame.label = {1, 0, 12};
  frame.instance = {0, 0, 3};
  frame.outcome = {Outcome::kReturned, Outcome::kNoSurface, Outcome::kReturned};
  return frame;
}

TEST(StreamPage, SpellsOutWhatTheEncoderSends) {
  StreamSpec spec;
  spec.run = 2;
  spec.sensor = 1;
  const auto datagrams = DatagramsOf(FrameOfThePage(), spec);
  ASSERT_EQ(datagrams.size(), 1U);
  const std::string page = DatagramOfThePage();
  ASSERT_EQ(page.size(), datagrams[0].size());
  for (std::size_t i = 0; i < page.size(); ++i) {
    EXPECT_EQ(page[i], datagrams[0][i]) << "byte " << i;
  }
}

// Checks the page's statement about the default fields.
TEST(StreamPage, SaysHowManyPointsADatagramHolds) {
  const ReceivedFrame received = ReceiveWhole(StreamFrame(0));
  EXPECT_EQ(received.header.point_size, 30);
  EXPECT_EQ((received.header.num_points + 38) / 39, received.num_packets);
  EXPECT_NEAR(39.0 * 65'535, 2.5e6, 0.1e6);
}

}  // namespace
}  // namespace railcast
