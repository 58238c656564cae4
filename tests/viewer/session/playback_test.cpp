#include "viewer/session/playback.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/core/io/stream/image_example.h"
#include "tests/core/io/stream/live_stream.h"
#include "tests/viewer/session/held_frames.h"

namespace railcast {
namespace {

using testing::HasSubstr;

constexpr double kStart_s = 1000.0;
constexpr double kPeriod_s = 0.2;  // That of NumberedCloud().

/// Returns frames 0 to 4; number 3 cannot be read if `is_damaged`.
std::vector<std::shared_ptr<const ShownFrame>> FiveFrames(bool is_damaged) {
  std::vector<std::shared_ptr<const ShownFrame>> frames;
  for (std::uint32_t i = 0; i < 5; ++i) frames.push_back(Share(NumberedCloud(i)));
  if (is_damaged) frames[3] = nullptr;
  return frames;
}

class PlaybackOfFive : public testing::Test {
 protected:
  explicit PlaybackOfFive(bool is_damaged = false) : frames_(FiveFrames(is_damaged)) {
    EXPECT_TRUE(session_.Seek(0));
    playback_.Begin(kStart_s);
  }

  HeldFrames frames_;
  Session session_{{&frames_}, {}};
  Playback playback_{session_, nullptr};
};

class PlaybackOfDamaged : public PlaybackOfFive {
 protected:
  PlaybackOfDamaged() : PlaybackOfFive(true) {}
};

TEST_F(PlaybackOfFive, ShowsAFrameAPeriodAndStopsAtTheEnd) {
  EXPECT_FALSE(playback_.Advance(kStart_s + 10.0)) << "it does not play yet";
  playback_.TogglePlaying(kStart_s);
  for (std::size_t place = 2; place < 5; ++place) {  // Playing begins by showing the next frame.
    const double now_s = kStart_s + (static_cast<double>(place) - 0.9) * kPeriod_s;
    EXPECT_TRUE(playback_.Advance(now_s)) << place;
    EXPECT_EQ(session_.place(), place);
  }
  EXPECT_TRUE(playback_.Advance(kStart_s + 100.0));
  EXPECT_EQ(session_.place(), 4U);
  EXPECT_FALSE(playback_.is_playing());
  EXPECT_EQ(playback_.StatusText(), "5 of 5   paused x1");
}

TEST_F(PlaybackOfFive, BeginsAnewFromTheEnd) {
  playback_.SeekTo(4, kStart_s);
  playback_.TogglePlaying(kStart_s);
  EXPECT_TRUE(playback_.is_playing());
  EXPECT_EQ(session_.place(), 0U);
}

TEST_F(PlaybackOfFive, StepsAndStaysBetweenTheEnds) {
  playback_.Step(2, kStart_s);
  EXPECT_EQ(session_.place(), 2U);
  playback_.Step(-5, kStart_s);
  EXPECT_EQ(session_.place(), 0U);
  playback_.Step(100, kStart_s);
  EXPECT_EQ(session_.place(), 4U);
  playback_.SeekTo(77, kStart_s);
  EXPECT_EQ(session_.place(), 4U) << "there is no such frame";
}

TEST_F(PlaybackOfDamaged, PausesWhereAFrameCannotBeRead) {
  playback_.SeekTo(2, kStart_s);
  EXPECT_EQ(playback_.fault(), "");
  playback_.TogglePlaying(kStart_s);
  EXPECT_FALSE(playback_.is_playing());
  EXPECT_EQ(session_.place(), 2U) << "what was shown stays";
  EXPECT_EQ(playback_.fault(), "held: is damaged");
}

TEST_F(PlaybackOfDamaged, StepsOverAFrameThatCannotBeRead) {
  playback_.SeekTo(2, kStart_s);
  playback_.Step(1, kStart_s);
  EXPECT_EQ(playback_.fault(), "held: is damaged");
  playback_.Step(1, kStart_s);
  EXPECT_EQ(session_.place(), 4U);
  EXPECT_EQ(playback_.fault(), "");
  playback_.Step(-1, kStart_s);
  playback_.Step(-1, kStart_s);
  EXPECT_EQ(session_.place(), 2U);
}

TEST_F(PlaybackOfDamaged, PlaysBesideAFrameThatCannotBeRead) {
  playback_.SeekTo(4, kStart_s);
  // The period is taken from the neighbouring frame, which is the damaged one.
  EXPECT_EQ(session_.Period_s(), 0.1);
}

TEST(PlaybackOfALiveSource, ShowsAnImageThatComesAfterItsFrame) {
  LiveFrames frames("udp://here", kAnyLoopbackPort, {}, kAnyLoopbackPort);
  Session session({&frames}, {});
  Playback playback(session, &frames);
  playback.Begin(kStart_s);
  LiveStream stream(frames.at());
  stream.Send(0);
  ASSERT_TRUE(Eventually([&] { return playback.Advance(kStart_s); }));
  EXPECT_EQ(session.Compose().front().picture, nullptr);
  playback.TogglePlaying(kStart_s);
  EXPECT_FALSE(playback.Advance(kStart_s)) << "paused";
  UdpSender camera({*frames.images_at()}, 0);
  SendImage(0, 0, camera);
  ASSERT_TRUE(Eventually([&] { return playback.Advance(kStart_s); }));
  ASSERT_NE(session.Compose().front().picture, nullptr);
  EXPECT_EQ(session.Compose().front().picture->title, "color   frame 0");
}

TEST_F(PlaybackOfFive, SaysHowFastFramesCome) {
  playback_.TogglePlaying(kStart_s);
  playback_.Faster(kStart_s);
  EXPECT_TRUE(playback_.Advance(kStart_s + 0.11));
  EXPECT_TRUE(playback_.Advance(kStart_s + 0.21));
  EXPECT_EQ(playback_.StatusText(), "4 of 5   playing x2   10.0 frames/s");
}

}  // namespace
}  // namespace railcast
