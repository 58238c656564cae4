#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <string>

#include "tests/core/io/stream/listening_program.h"
#include "tests/core/io/stream/live_stream.h"

namespace railcast {
namespace {

constexpr char kReceiver[] =
    "/usr/bin/python3 " RAILCAST_SOURCE_DIR "/examples/receive_stream.py 127.0.0.1:0 --frames 3";

double Nearest_m(const Frame& frame) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    const Vector3 point(frame.x[i], frame.y[i], frame.z[i]);
    if (HasPoint(frame.outcome[i])) nearest_m = std::min(nearest_m, point.norm());
  }
  return nearest_m;
}

std::string WholeFrameLine(std::uint32_t index) {
  const Frame frame = StreamFrame(index);
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "frame %u: 960 points, 0 packets lost, nearest %.2f m\n",
                index, Nearest_m(frame));
  return text.data();
}

TEST(PythonReceiver, PrintsALineForEachFrame) {
  ListeningProgram receiver(kReceiver);
  LiveStream stream(receiver.at());
  for (std::uint32_t index = 0; index < 3; ++index) {
    stream.Send(index);
    EXPECT_EQ(receiver.Line(), WholeFrameLine(index));
  }
  EXPECT_EQ(receiver.Line(), "");
}

TEST(PythonReceiver, SaysWhatWasLostAndSurvivesWhatIsNotOurs) {
  ListeningProgram receiver(kReceiver);
  const std::string sound = DatagramsOf(StreamFrame(0)).front();
  Datagrams hostile;
  for (const std::string& bytes :
       {std::string("hello"), std::string(1400, 'R'), sound.substr(0, 90), std::string("x"),
        With<std::uint16_t>(sound, 168, 65'535), With<std::uint8_t>(sound, 170, 1),
        With<char>(sound, 172, '\xff'), With<std::uint16_t>(sound, 6, 60'000)}) {
    hostile.items.push_back(
        {hostile.bytes.size(), static_cast<std::uint16_t>(bytes.size()), DatagramPort::kData, 0});
    hostile.bytes.insert(hostile.bytes.end(), bytes.begin(), bytes.end());
  }
  UdpSender({receiver.at()}, 0).Send(hostile, hostile.items);
  LiveStream stream(receiver.at());
  stream.SendWithout(0, 3);
  stream.Send(1);
  EXPECT_THAT(receiver.Line(), testing::StartsWith("frame 0: 921 points, 1 packets lost"));
  EXPECT_EQ(receiver.Line(), WholeFrameLine(1));
  StreamSpec restarted;
  restarted.run = 1;
  stream.Restart(restarted);
  stream.Send(0);
  EXPECT_EQ(receiver.Line(), WholeFrameLine(0));
}

}  // namespace
}  // namespace railcast
