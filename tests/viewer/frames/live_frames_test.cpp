#include "viewer/frames/live_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/stream/live_stream.h"

namespace railcast {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

bool EventuallyPolls(LiveFrames& frames) {
  return Eventually([&] { return frames.Poll(); });
}

/// The stream of a sender with these fields. The larger its run, the later it began.
StreamSpec Fields(const std::string& fields, std::uint32_t run) {
  return {.fields = FieldSelection(fields), .run = run};
}

TEST(LiveFrames, AreThoseThatAreSent) {
  LiveFrames frames("udp://here", kAnyLoopbackPort);
  EXPECT_EQ(frames.info().kind, "live stream");
  EXPECT_EQ(frames.num_known(), 0U);
  EXPECT_EQ(frames.first_known(), 0U);
  EXPECT_FALSE(frames.Poll());
  EXPECT_EQ(frames.Get(0), nullptr);
  LiveStream stream(frames.at());
  for (std::uint32_t place = 0; place < 3; ++place) {
    stream.Send(9 + place);
    ASSERT_TRUE(EventuallyPolls(frames)) << place;
    EXPECT_EQ(frames.num_known(), place + 1);
  }
  EXPECT_FALSE(frames.Poll()) << "none since";
  for (std::uint32_t place = 0; place < 3; ++place) {
    const auto shown = frames.Get(place);
    ASSERT_TRUE(shown) << place;
    EXPECT_EQ(shown->frame().index, 9 + place);
    EXPECT_EQ(shown->recorded->name, "udp://here");
    EXPECT_EQ(shown->num_points(), ReceiveWhole(StreamFrame(9 + place)).num_points());
  }
  EXPECT_EQ(frames.Get(3), nullptr);
}

TEST(LiveFrames, PassOverAllButTheLatest) {
  LiveFrames frames("udp://here", kAnyLoopbackPort);
  LiveStream stream(frames.at());
  std::uint32_t next = 0;
  // On a slow machine each frame may be polled before the next has come, so this is tried
  // repeatedly.
  EXPECT_TRUE(Eventually([&] {
    const std::size_t num_before = frames.num_known();
    for (int i = 0; i < 3; ++i) stream.Send(next++);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const bool has_come = Eventually([&] {
      return frames.Poll() && frames.Get(frames.num_known() - 1)->frame().index == next - 1;
    });
    return has_come && frames.num_known() == num_before + 1;
  }));
}

TEST(LiveFrames, ForgetAllButTheLast64) {
  LiveFrames frames("udp://here", kAnyLoopbackPort);
  LiveStream stream(frames.at());
  for (std::uint32_t index = 0; index < 65; ++index) {
    stream.Send(index);
    ASSERT_TRUE(EventuallyPolls(frames)) << index;
  }
  EXPECT_EQ(frames.num_known(), 65U);
  EXPECT_EQ(frames.first_known(), 1U);
  EXPECT_EQ(frames.Get(0), nullptr);
  EXPECT_EQ(frames.Get(1)->frame().index, 1U);
  EXPECT_EQ(frames.Get(64)->frame().index, 64U);
}

TEST(LiveFrames, CountThePacketsThatAreLost) {
  LiveFrames frames("udp://here", kAnyLoopbackPort);
  LiveStream stream(frames.at());
  stream.SendWithout(0, 1);
  // The incomplete frame is given up as soon as a later one is complete.
  stream.Send(1);
  ASSERT_TRUE(Eventually([&] {
    (void)frames.Poll();
    return frames.num_known() > 0 && frames.Get(frames.num_known() - 1)->frame().index == 1;
  }));
  EXPECT_EQ(frames.FirstWhole(0, false), frames.num_known() - 1);
  EXPECT_THAT(frames.StatusText(), HasSubstr("   1 packets lost"));
}

TEST(LiveFrames, SayWhichIsWithoutGaps) {
  LiveFrames frames("udp://here", kAnyLoopbackPort);
  LiveStream stream(frames.at());
  stream.SendWithout(0, 1);
  // No more packets come, so after a second the frame is delivered incomplete.
  ASSERT_TRUE(EventuallyPolls(frames));
  EXPECT_EQ(frames.FirstWhole(0, false), std::nullopt);
  const ReceivedFrame whole = ReceiveWhole(StreamFrame(0));
  EXPECT_LT(frames.Get(0)->num_points(), whole.num_points());
  EXPECT_GT(frames.Get(0)->num_points(), 0U);
}

TEST(LiveFrames, SayWhyAFrameCannotBeShownUntilOneCan) {
  LiveFrames frames("udp://here", kAnyLoopbackPort);
  LiveStream stream(frames.at(), Fields("x,y,z", 1));
  stream.Send(0);
  ASSERT_TRUE(EventuallyPolls(frames));
  EXPECT_EQ(frames.fault(), "");
  EXPECT_THAT(frames.StatusText(), StartsWith("live "));
  EXPECT_THAT(frames.StatusText(), EndsWith(" frames/s   0 packets lost"));
  stream.Restart(Fields("intensity", 2));
  stream.Send(0);
  ASSERT_TRUE(Eventually([&] { return frames.Poll() || !frames.fault().empty(); }));
  EXPECT_EQ(frames.fault(), "udp://here: has no field x");
  EXPECT_THAT(frames.StatusText(), EndsWith("   not shown: udp://here: has no field x"));
  EXPECT_EQ(frames.num_known(), 1U);
  stream.Restart(Fields("x,y,z", 3));
  stream.Send(5);
  ASSERT_TRUE(EventuallyPolls(frames));
  EXPECT_EQ(frames.fault(), "");
  EXPECT_EQ(frames.Get(1)->frame().index, 5U);
}

TEST(LiveFrames, AreNotDrawnInAScenarioByTheTimeOfDay) {
  LiveFrames frames("udp://here", kAnyLoopbackPort);
  frames.UseScenario(ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/minimal.json"));
  LiveStream stream(frames.at());
  stream.SetClockAhead(1'795'000'000'000'000'000);
  stream.Send(0);
  ASSERT_TRUE(Eventually([&] { return frames.Poll() || !frames.fault().empty(); }));
  EXPECT_EQ(frames.fault(),
            "udp://here: stamps must be simulation time where a scenario is drawn (got the time of "
            "day)");
}

TEST(LiveFrames, AreOfOneSensorIfTwoSendToThePort) {
  LiveFrames frames("udp://here", kAnyLoopbackPort, {.sensor = 1});
  StreamSpec roof_spec{.sensor = 1};
  LiveStream front(frames.at());
  LiveStream roof(frames.at(), roof_spec);
  for (std::uint32_t place = 0; place < 3; ++place) {
    front.Send(100 + place);
    roof.Send(place);
    ASSERT_TRUE(EventuallyPolls(frames)) << place;
    EXPECT_EQ(frames.Get(place)->frame().index, place);
  }
  EXPECT_THAT(frames.StatusText(), EndsWith("   0 packets lost   also heard: sensor 0"));
}

TEST(LiveFrames, AreOfTheFirstSenderIfTwoSendToThePort) {
  LiveFrames frames("udp://here", kAnyLoopbackPort);
  LiveStream stream(frames.at());
  stream.Send(0);
  ASSERT_TRUE(EventuallyPolls(frames));
  LiveStream forger(frames.at(), Fields("x,y,z", 99));
  forger.Send(7);
  stream.Send(1);
  ASSERT_TRUE(EventuallyPolls(frames));
  EXPECT_EQ(frames.Get(1)->frame().index, 1U);
  EXPECT_THAT(frames.StatusText(), HasSubstr("   0 packets lost   also heard: 127.0.0.1:"));
}

TEST(LiveFrames, SayHowLongNoneHasCome) {
  LiveFrames frames("udp://here", kAnyLoopbackPort);
  EXPECT_EQ(frames.seconds_since_last(), std::numeric_limits<double>::infinity());
  LiveStream stream(frames.at());
  const auto before = std::chrono::steady_clock::now();
  stream.Send(0);
  ASSERT_TRUE(Eventually([&] { return std::isfinite(frames.seconds_since_last()); }));
  EXPECT_EQ(frames.num_known(), 0U) << "nor was it taken";
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const double since_s = frames.seconds_since_last();
  const std::chrono::duration<double> most = std::chrono::steady_clock::now() - before;
  EXPECT_GE(since_s, 0.02);
  EXPECT_LE(since_s, most.count());
}

TEST(LiveFrames, SayThatAPortIsTaken) {
  const LiveFrames first("udp://here", kAnyLoopbackPort);
  EXPECT_EQ(MessageOf([&] { const LiveFrames second("udp://there", first.at()); }),
            "cannot listen: Address already in use (got " + EndpointText(first.at()) + ")");
}

}  // namespace
}  // namespace railcast
