#include "viewer/session/playback.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
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

// Times are multiples of 1/8 s, so their sums are exact.
constexpr double kPlayedPeriod_s = 0.125;
constexpr double kPlayedStart_s = 1000.0;

Player Playing(std::size_t place = 0) {
  Player player;
  player.Seek(place, kPlayedStart_s);
  player.Play(kPlayedStart_s);
  return player;
}

TEST(Player, ShowsTheFirstFrameUntilItPlays) {
  Player player;
  EXPECT_FALSE(player.is_playing());
  EXPECT_FALSE(player.Advance(1e9, kPlayedPeriod_s));
  EXPECT_EQ(player.place(), 0U);
  EXPECT_EQ(player.speed_factor(), 1.0);
}

TEST(Player, ShowsAFrameAPeriod) {
  Player player = Playing(5);
  EXPECT_TRUE(player.is_playing());
  EXPECT_FALSE(player.Advance(kPlayedStart_s + 0.124, kPlayedPeriod_s));
  EXPECT_EQ(player.place(), 5U);
  EXPECT_TRUE(player.Advance(kPlayedStart_s + 0.125, kPlayedPeriod_s));
  EXPECT_EQ(player.place(), 6U);
  EXPECT_FALSE(player.Advance(kPlayedStart_s + 0.125, kPlayedPeriod_s)) << "once";
}

TEST(Player, LeavesOutFramesThatItIsTooLateFor) {
  Player player = Playing();
  EXPECT_TRUE(player.Advance(kPlayedStart_s + 0.45, kPlayedPeriod_s));
  EXPECT_EQ(player.place(), 3U);
  // The schedule is kept: the next frame is due at 0.5 s, not 0.125 s after the late one.
  EXPECT_TRUE(player.Advance(kPlayedStart_s + 0.5, kPlayedPeriod_s));
  EXPECT_EQ(player.place(), 4U);
}

TEST(Player, GoesOnAfterAPauseWithoutSkipping) {
  Player player = Playing();
  player.Pause();
  EXPECT_FALSE(player.is_playing());
  EXPECT_FALSE(player.Advance(kPlayedStart_s + 10.0, kPlayedPeriod_s));
  player.Play(kPlayedStart_s + 10.0);
  EXPECT_FALSE(player.Advance(kPlayedStart_s + 10.1, kPlayedPeriod_s));
  EXPECT_TRUE(player.Advance(kPlayedStart_s + 10.125, kPlayedPeriod_s));
  EXPECT_EQ(player.place(), 1U);
}

TEST(Player, PlaysOnFromWhereItIsPut) {
  Player player = Playing();
  player.Seek(40, kPlayedStart_s + 0.1);
  EXPECT_EQ(player.place(), 40U);
  EXPECT_TRUE(player.is_playing());
  EXPECT_FALSE(player.Advance(kPlayedStart_s + 0.2, kPlayedPeriod_s));
  EXPECT_TRUE(player.Advance(kPlayedStart_s + 0.25, kPlayedPeriod_s));
  EXPECT_EQ(player.place(), 41U);
}

TEST(Player, DoublesAndHalvesItsSpeed) {
  Player player = Playing();
  player.Faster(kPlayedStart_s);
  EXPECT_EQ(player.speed_factor(), 2.0);
  EXPECT_TRUE(player.Advance(kPlayedStart_s + 0.0625, kPlayedPeriod_s));
  EXPECT_EQ(player.place(), 1U);
  player.Slower(kPlayedStart_s + 0.0625);
  player.Slower(kPlayedStart_s + 0.0625);
  EXPECT_EQ(player.speed_factor(), 0.5);
  EXPECT_FALSE(player.Advance(kPlayedStart_s + 0.25, kPlayedPeriod_s));
  EXPECT_TRUE(player.Advance(kPlayedStart_s + 0.3125, kPlayedPeriod_s));
  EXPECT_EQ(player.place(), 2U);
}

TEST(Player, HasALowestAndAHighestSpeed) {
  Player player;
  for (int i = 0; i < 10; ++i) player.Faster(0.0);
  EXPECT_EQ(player.speed_factor(), 16.0);
  for (int i = 0; i < 20; ++i) player.Slower(0.0);
  EXPECT_EQ(player.speed_factor(), 1.0 / 16.0);
  player.Faster(0.0);
  EXPECT_EQ(player.speed_factor(), 0.125);
}

TEST(Player, ShowsNoFrameAtOnceWhenItsSpeedRises) {
  Player player = Playing();
  // A frame has been shown for 0.1 s; at 16 times the speed that would be 12 frames.
  for (int i = 0; i < 4; ++i) player.Faster(kPlayedStart_s + 0.1);
  EXPECT_FALSE(player.Advance(kPlayedStart_s + 0.1, kPlayedPeriod_s));
}

}  // namespace
}  // namespace railcast
