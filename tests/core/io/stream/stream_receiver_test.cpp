#include "railcast/io/stream.h"

#include <gtest/gtest.h>

#include "tests/core/io/message_of.h"
#include "tests/core/io/stream/live_stream.h"

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

}  // namespace
}  // namespace railcast
