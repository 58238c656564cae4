#include "core/io/stream/stream_datagram.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <string>

#include "core/base/random.h"
#include "core/io/write_file.h"
#include "tests/core/io/stream/stream_example.h"

namespace railcast {
namespace {

std::string FaultOf(const std::string& datagram) {
  StreamFault fault{};
  if (CheckStreamDatagram(datagram, fault)) return "none";
  return std::string(kStreamFaultNames[static_cast<std::size_t>(fault)]);
}

/// Returns the first of several datagrams of a frame.
std::string First() {
  return DatagramsOf(StreamFrame(1)).front();
}

TEST(CheckStreamDatagram, TakesWhatTheEncoderSends) {
  for (const std::string& datagram : DatagramsOf(StreamFrame(1))) {
    EXPECT_EQ(FaultOf(datagram), "none");
  }
}

TEST(CheckStreamDatagram, RefusesEveryTruncation) {
  const std::string whole = First();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(FaultOf(whole.substr(0, size)), "none") << size;
    if (size < 4) continue;
    std::string sealed = whole.substr(0, size);
    Seal(sealed);
    EXPECT_EQ(FaultOf(sealed), "size") << size;
  }
}

TEST(CheckStreamDatagram, RefusesMoreBytesThanItSaysOrMayHave) {
  std::string longer = First() + "x";
  Seal(longer);
  EXPECT_EQ(FaultOf(longer), "size");
  EXPECT_EQ(FaultOf(std::string(1401, 'x')), "size");
  EXPECT_EQ(FaultOf(std::string(65'507, 'x')), "size");
}

TEST(CheckStreamDatagram, RefusesEverySingleWrongBit) {
  const std::string whole = First();
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    const std::string fault = FaultOf(damaged);
    const std::string expected = bit < 32 ? "magic" : bit < 40 ? "version" : "checksum";
    EXPECT_EQ(fault, expected) << bit;
  }
}

TEST(CheckStreamDatagram, RefusesOtherVersionsAndFlags) {
  EXPECT_EQ(FaultOf(With<std::uint8_t>(First(), 4, 2)), "version");
  EXPECT_EQ(FaultOf(With<std::uint8_t>(First(), 5, 6)), "version");   // Undefined axes.
  EXPECT_EQ(FaultOf(With<std::uint8_t>(First(), 5, 16)), "version");  // Undefined flag.
}

TEST(CheckStreamDatagram, RefusesSizesThatDoNotAddUp) {
  EXPECT_EQ(FaultOf(With<std::uint16_t>(First(), 6, 169)), "size");     // header_size
  EXPECT_EQ(FaultOf(With<std::uint16_t>(First(), 6, 65'535)), "size");  // header_size
  EXPECT_EQ(FaultOf(With<std::uint16_t>(First(), 14, 1)), "size");      // points
  EXPECT_EQ(FaultOf(With<std::uint16_t>(First(), 54, 29)), "size");     // point_size
}

TEST(CheckStreamDatagram, RefusesFieldListsThatAreNone) {
  const std::string first = First();
  EXPECT_EQ(FaultOf(With<std::uint16_t>(first, 168, 0)), "fields");       // No field.
  EXPECT_EQ(FaultOf(With<std::uint16_t>(first, 168, 7)), "fields");       // One is not counted.
  EXPECT_EQ(FaultOf(With<std::uint16_t>(first, 168, 65'535)), "fields");  // More than listed.
  EXPECT_EQ(FaultOf(With<std::uint8_t>(first, 170, 8)), "fields");        // Not a field type.
  EXPECT_EQ(FaultOf(With<std::uint8_t>(first, 170, 4)), "fields");        // Not point_size.
  EXPECT_EQ(FaultOf(With<std::uint8_t>(first, 171, 0)), "fields");        // Empty name.
  EXPECT_EQ(FaultOf(With<std::uint8_t>(first, 171, 255)), "fields");      // Beyond the list.
  EXPECT_EQ(FaultOf(With<char>(first, 172, '\x1b')), "fields");           // Not a letter.
  EXPECT_EQ(FaultOf(With<char>(first, 172, 'y')), "fields");              // The same name twice.
}

TEST(CheckStreamDatagram, RefusesCountsThatContradictEachOther) {
  const std::string first = First();
  EXPECT_EQ(FaultOf(With<std::uint16_t>(first, 22, 0)), "counts");    // No packets.
  EXPECT_EQ(FaultOf(With<std::uint16_t>(first, 22, 1)), "counts");    // Points without packets.
  EXPECT_EQ(FaultOf(With<std::uint16_t>(first, 22, 500)), "counts");  // Packets without points.
  EXPECT_EQ(FaultOf(With<std::uint16_t>(first, 20, 1)), "counts");    // Not where it begins.
  EXPECT_EQ(FaultOf(With<std::uint16_t>(first, 20, 900)), "counts");  // Beyond the last packet.
  EXPECT_EQ(FaultOf(With<std::uint32_t>(first, 40, 1)), "counts");    // First point.
  EXPECT_EQ(FaultOf(With<std::uint32_t>(first, 36, 0)), "counts");    // Points of the frame.
  EXPECT_EQ(FaultOf(With<std::uint32_t>(first, 36, 0xFFFFFFFF)), "counts");
  EXPECT_EQ(FaultOf(With<std::uint32_t>(first, 44, 0)), "counts");  // Rows.
  EXPECT_EQ(FaultOf(With<std::uint32_t>(first, 44, 1)), "counts");  // More points than slots.
  EXPECT_EQ(FaultOf(With<std::uint16_t>(first, 52, 0)), "counts");  // Returns.
  EXPECT_EQ(FaultOf(With<std::uint8_t>(first, 5, 1)), "counts");    // Fewer points than slots.
}

TEST(CheckStreamDatagram, RefusesPosesThatAreNone) {
  const std::string first = First();
  EXPECT_EQ(FaultOf(With(first, 56, std::numeric_limits<double>::infinity())), "pose");
  EXPECT_EQ(FaultOf(With(first, 112, std::nan(""))), "pose");
  EXPECT_EQ(FaultOf(With(first, 104, 7.0)), "pose");
  EXPECT_EQ(FaultOf(With(first, 160, std::numeric_limits<double>::max())), "pose");
}

TEST(CheckStreamDatagram, SurvivesWhatever) {
  const std::string first = First();
  int num_taken = 0;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    std::string hostile = first;
    const auto words = RandomWords(3, RandomUse::kNoise, 0, i);
    const std::size_t at = words[0] % 224;
    hostile[at] = static_cast<char>(words[1]);
    hostile[(at + words[2] % 4) % 224] = static_cast<char>(words[3]);
    Seal(hostile);
    if (FaultOf(hostile) == "none") ++num_taken;
  }
  // Some changes leave a valid datagram: stamps, last digits of poses, frame and run numbers.
  EXPECT_GT(num_taken, 1000);
  EXPECT_LT(num_taken, 15'000);
}

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
