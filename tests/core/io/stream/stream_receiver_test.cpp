#include "railcast/io/stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <string>

#include "tests/core/io/message_of.h"
#include "tests/core/io/stream/listening_program.h"
#include "tests/core/io/stream/live_stream.h"
#include "tests/support/made_datagrams.h"

namespace railcast {
namespace {

constexpr int kLong_ms = 20'000;

TEST(StreamReceiver, GivesTheFramesThatASenderSends) {
  StreamReceiver receiver(kAnyLoopbackPort);
  LiveStream stream(receiver.at());
  for (std::uint32_t index = 0; index < 20; ++index) {
    stream.Send(index);
    const auto frame = receiver.Next(kLong_ms);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->header.frame, index);
    EXPECT_TRUE(frame->is_complete());
    EXPECT_EQ(frame->points, ReceiveWhole(StreamFrame(index)).points);
  }
  EXPECT_EQ(receiver.counts().stream.complete_frames, 20U);
  EXPECT_EQ(receiver.counts().dropped_frames, 0U);
}

TEST(StreamReceiver, KeepsTheLatestFramesForASlowConsumer) {
  StreamReceiver receiver(kAnyLoopbackPort);
  LiveStream stream(receiver.at());
  for (std::uint32_t index = 0; index < 10; ++index) {
    stream.Send(index);
    ASSERT_TRUE(Eventually([&] { return receiver.counts().stream.complete_frames == index + 1; }));
  }
  EXPECT_EQ(receiver.counts().dropped_frames, 10 - StreamReceiver::kMaxWaitingFrames);
  for (std::uint32_t index = 10 - StreamReceiver::kMaxWaitingFrames; index < 10; ++index) {
    const auto frame = receiver.Next(kLong_ms);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->header.frame, index);
  }
}

TEST(StreamReceiver, GivesTheFramesOfTheFirstSenderWhateverAForgerSends) {
  StreamReceiver receiver(kAnyLoopbackPort);
  LiveStream stream(receiver.at());
  stream.Send(0);
  ASSERT_TRUE(receiver.Next(kLong_ms));
  StreamSpec later_run;
  later_run.run = 1'000'000;
  LiveStream forger(receiver.at(), later_run);
  for (std::uint32_t index = 1; index < 10; ++index) {
    // The forger's datagrams arrive in the middle of each frame, with a rising run number.
    stream.SendWithout(index, 12);
    forger.Send(4'000'000'000);
    later_run.run += 1000;
    forger.Restart(later_run);
    stream.SendOnly(index, 12);
    const auto frame = receiver.Next(kLong_ms);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->header.frame, index);
    EXPECT_TRUE(frame->is_complete());
  }
  EXPECT_EQ(receiver.counts().stream.restarts, 0U);
  EXPECT_GT(receiver.counts().stream.other_sender_packets, 0U);
}

TEST(StreamReceiver, GivesAnOpenFrameInSilence) {
  StreamReceiver receiver(kAnyLoopbackPort);
  LiveStream stream(receiver.at());
  stream.SendWithout(0, 2);
  const auto frame = receiver.Next(kLong_ms);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->lost_packets, (std::vector<IndexRange>{{2, 1}}));
}

TEST(StreamReceiver, GivesOpenFramesWhenStopped) {
  StreamReceiver receiver(kAnyLoopbackPort);
  LiveStream stream(receiver.at());
  stream.SendWithout(0, 0);
  ASSERT_TRUE(Eventually([&] { return receiver.counts().stream.received_packets == 24; }));
  receiver.Stop();
  const auto frame = receiver.Next(0);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->lost_packets, (std::vector<IndexRange>{{0, 1}}));
  EXPECT_FALSE(receiver.Next(kLong_ms)) << "does not wait for what cannot come";
}

TEST(StreamReceiver, FreesItsPortWhenStopped) {
  StreamReceiver first(kAnyLoopbackPort);
  EXPECT_EQ(MessageOf([&] { const StreamReceiver second(first.at()); }),
            "cannot listen: Address already in use (got " + EndpointText(first.at()) + ")");
  first.Stop();
  first.Stop();
  EXPECT_EQ(MessageOf([&] { const StreamReceiver second(first.at()); }), "no error");
}

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
    AddDatagram(bytes, hostile);
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
