#include "core/rail/chunk/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

TEST(SweepStations, KeepChordsWithinTheToleranceOnAnArc) {
  constexpr double kRadius_m = 300.0;
  constexpr double kOffset_m = 4.0;  // Towards the centre of the curve: radius 296 m.
  constexpr double kTolerance_m = 1e-3;
  const TestLine line(CantedArc(500.0, kRadius_m));
  const auto stations_m =
      SweepStations(line.alignment(), {100.0, 150.0}, kOffset_m, kTolerance_m, 5.0);
  EXPECT_EQ(stations_m.front(), 100.0);
  EXPECT_EQ(stations_m.back(), 150.0);
  const double step_m = stations_m[1] - stations_m[0];
  const double chord_m = step_m * (kRadius_m - kOffset_m) / kRadius_m;
  EXPECT_LE(chord_m * chord_m / (8.0 * (kRadius_m - kOffset_m)), kTolerance_m);
  // The number of stations is minimal: with one chord less, chords would be too long.
  const double longer_m = chord_m * static_cast<double>(stations_m.size() - 1) /
                          static_cast<double>(stations_m.size() - 2);
  EXPECT_GT(longer_m * longer_m / (8.0 * (kRadius_m - kOffset_m)), 0.95 * kTolerance_m);
}

TEST(SweepStations, AreAtMostTheLongestStepApartOnAStraight) {
  const TestLine line(StraightLine(500.0));
  EXPECT_THAT(SweepStations(line.alignment(), {100.0, 110.0}, 0.0, 1e-3, 5.0),
              testing::ElementsAre(100.0, 105.0, 110.0));
}

TEST(GridStations, AreMultiplesBetweenTheEnds) {
  EXPECT_THAT(GridStations({9.9995, 11.0005}, 0.25),
              testing::ElementsAre(9.9995, 10.25, 10.5, 10.75, 11.0005));
  EXPECT_THAT(GridStations({10.1, 10.8}, 0.25), testing::ElementsAre(10.1, 10.25, 10.5, 10.8));
}

TEST(SweptRange, EndsWithTheTrackOrHalfAnOverlapBeyondTheChunk) {
  WorldSpec spec = StraightLine(500.0);
  spec.tracks[0].end_s_m = 120.0;
  const TestLine line(spec);
  const TrackCourse& track = line.network().courses[0];
  const ChainageRange whole{track.begin_s_m(), track.end_s_m()};
  const ChainageRange inside = SweptRange(line.Context(1), whole);
  EXPECT_DOUBLE_EQ(inside.begin_s_m, 49.9995);
  EXPECT_DOUBLE_EQ(inside.end_s_m, 100.0005);
  EXPECT_DOUBLE_EQ(SweptRange(line.Context(2), whole).end_s_m, 120.0);
}

}  // namespace
}  // namespace railcast
