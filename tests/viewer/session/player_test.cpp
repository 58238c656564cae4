#include "viewer/session/player.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

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
