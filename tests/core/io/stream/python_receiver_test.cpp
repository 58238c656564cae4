#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <limits>
#include <string>

#include "tests/core/io/stream/live_stream.h"

namespace railcast {
namespace {

/// scripts/receive_stream.py at a free port.
class PythonReceiver {
 public:
  explicit PythonReceiver(const std::string& arguments)
      : pipe_(::popen(("timeout 60 /usr/bin/python3 " RAILCAST_SOURCE_DIR
                       "/scripts/receive_stream.py 127.0.0.1:0 " +
                       arguments + " 2>&1")
                          .c_str(),
                      "r")) {
    unsigned port = 0;
    const std::string line = Line();
    EXPECT_EQ(std::sscanf(line.c_str(), "listening at 127.0.0.1:%u", &port), 1) << line;
    at_ = {0x7F000001, static_cast<std::uint16_t>(port)};
  }
  ~PythonReceiver() { ::pclose(pipe_); }
  PythonReceiver(const PythonReceiver&) = delete;
  PythonReceiver& operator=(const PythonReceiver&) = delete;

  const Endpoint& at() const { return at_; }
  std::string Line() {
    std::array<char, 256> text{};
    return std::fgets(text.data(), text.size(), pipe_) == nullptr ? "" : text.data();
  }

 private:
  FILE* pipe_;
  Endpoint at_;
};

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
  PythonReceiver receiver("--frames 3");
  LiveStream stream(receiver.at());
  for (std::uint32_t index = 0; index < 3; ++index) {
    stream.Send(index);
    EXPECT_EQ(receiver.Line(), WholeFrameLine(index));
  }
  EXPECT_EQ(receiver.Line(), "");
}

TEST(PythonReceiver, SaysWhatWasLostAndSurvivesWhatIsNotOurs) {
  PythonReceiver receiver("--frames 3");
  const std::string sound = DatagramsOf(StreamFrame(0)).front();
  Datagrams hostile;
  for (const std::string& bytes :
       {std::string("hello"), std::string(1400, 'R'), sound.substr(0, 90), std::string("x"),
        With<std::uint16_t>(sound, 168, 65'535), With<std::uint8_t>(sound, 170, 1),
        With<char>(sound, 172, '\xff'), With<std::uint16_t>(sound, 6, 60'000)}) {
    hostile.items.push_back({hostile.bytes.size(), static_cast<std::uint16_t>(bytes.size()),
                             DatagramPort::kData, 0});
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
  LiveStream(receiver.at(), restarted).Send(0);
  EXPECT_EQ(receiver.Line(), WholeFrameLine(0));
}

}  // namespace
}  // namespace railcast
