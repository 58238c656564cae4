#include "viewer/overlays/overlays.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"
#include "viewer/color/palette.h"

namespace railcast {
namespace {

constexpr double kFarWall_m = 250.0;

/// A grey wall in front of a dark one whose echo is too weak, and sky; the sensor moves and turns.
std::shared_ptr<SimpleWorld> TwoWalls() {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeWall(30.0F, 3.0F), 2, 1},
                         {MakeWall(static_cast<float>(kFarWall_m), 40.0F), 1, 1}};
  world->velocity_chunk_mps = {40.0, 3.0, 0.0};
  world->yaw_rate_radps = 0.3;
  return world;
}

RecordedFrame Recorded(Frame frame) {
  RecordedFrame recorded;
  recorded.frame = std::move(frame);
  recorded.fields = {"time_ns", "outcome", "true_range_m"};
  recorded.is_grid = true;
  recorded.has_pose = true;
  return recorded;
}

RecordedFrame ScanTwoWalls(const ScanPattern& pattern) {
  return Recorded(ScanOnce(TwoWalls(), pattern, {.detector = {.effects = {.threshold = true}}}));
}

std::vector<std::size_t> EmptySlots(const Frame& frame) {
  std::vector<std::size_t> slots;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.range_m[slot])) slots.push_back(slot);
  }
  return slots;
}

TEST(EmptyBeams, AreTheFiringsThatBroughtNothingBackInTheirColours) {
  const ScanPattern pattern = MakeRaster(30.0, 20.0, 0.5);
  const RecordedFrame recorded = ScanTwoWalls(pattern);
  const Overlay drawing = DrawEmptyBeams(recorded, BeamsOf(pattern));
  const std::vector<std::size_t> empty = EmptySlots(recorded.frame);
  ASSERT_EQ(drawing.segments.size(), empty.size());
  int num_weak = 0;
  for (std::size_t i = 0; i < empty.size(); ++i) {
    const Outcome outcome = recorded.frame.outcome[empty[i]];
    EXPECT_EQ(drawing.segments[i].rgb, OutcomeRgb(outcome));
    num_weak += outcome == Outcome::kBelowThreshold ? 1 : 0;
  }
  // The far wall takes 36 x 36 beams at 0.5 deg, less those that the near one takes.
  EXPECT_GT(num_weak, 500);
  EXPECT_GT(drawing.segments.size(), static_cast<std::size_t>(num_weak) + 500);
}

TEST(EmptyBeams, PointWhereTheSensorLookedAtTheirTime) {
  const ScanPattern pattern = MakeRaster(30.0, 20.0, 0.5);
  const RecordedFrame recorded = ScanTwoWalls(pattern);
  const Beams beams = BeamsOf(pattern);
  const Overlay drawing = DrawEmptyBeams(recorded, beams);
  const std::shared_ptr<SimpleWorld> world = TwoWalls();
  const std::vector<std::size_t> empty = EmptySlots(recorded.frame);
  for (std::size_t i = 0; i < empty.size(); ++i) {
    const Transform world_from_sensor = world->WorldFromVehicle(beams.times_ns[empty[i]]);
    const Vector3 expected = world_from_sensor.linear() * beams.directions[empty[i]].cast<double>();
    const Overlay::Segment& segment = drawing.segments[i];
    const Vector3 way =
        recorded.frame.world_from_sensor.linear() * (segment.to_m - segment.from_m).cast<double>();
    ASSERT_LT(way.normalized().cross(expected).norm(), 1e-5);
    ASSERT_GT(way.dot(expected), 0.0);
    const Vector3 start = recorded.frame.world_from_sensor * segment.from_m.cast<double>();
    ASSERT_NEAR((start - world_from_sensor.translation()).norm(), kEmptyBeamStart_m, 1e-5);
  }
}

TEST(EmptyBeams, EndOnWhatWasTooWeakOrAfterAStub) {
  const ScanPattern pattern = MakeRaster(30.0, 20.0, 0.5);
  const RecordedFrame recorded = ScanTwoWalls(pattern);
  const Overlay drawing = DrawEmptyBeams(recorded, BeamsOf(pattern));
  for (const Overlay::Segment& segment : drawing.segments) {
    if (segment.rgb == OutcomeRgb(Outcome::kBelowThreshold)) {
      const Vector3 end = recorded.frame.world_from_sensor * segment.to_m.cast<double>();
      ASSERT_NEAR(end.x(), kFarWall_m, 1e-3);
    } else {
      ASSERT_NEAR((segment.to_m - segment.from_m).norm(), 10.0F, 1e-5F);
    }
  }
}

TEST(EmptyBeams, PointTheSameWayByTheFramesOwnPoints) {
  const ScanPattern pattern = MakeRaster(8.0, 8.0, 0.5);
  auto world = std::make_shared<SimpleWorld>();
  // Only the half below the falling diagonal is covered; all but the last rows and columns have
  // points.
  const Mesh half{{{30.0F, -2.5F, -2.5F}, {30.0F, 2.5F, -2.5F}, {30.0F, -2.5F, 2.5F}}, {{0, 1, 2}}};
  world->ground.parts = {{half, 2, 1}};
  const RecordedFrame recorded = Recorded(ScanOnce(world, pattern));
  const std::optional<Beams> found = BeamsOf(recorded);
  ASSERT_TRUE(found);
  const Beams exact = BeamsOf(pattern);
  int num_empty = 0;
  for (const std::size_t slot : EmptySlots(recorded.frame)) {
    if (!found->directions[slot].allFinite()) continue;
    EXPECT_LT((found->directions[slot] - exact.directions[slot]).norm(), 1e-4F);
    EXPECT_EQ(found->times_ns[slot], exact.times_ns[slot]);
    ++num_empty;
  }
  EXPECT_GT(num_empty, 50);
}

TEST(EmptyBeams, TakeNoNoticeOfUnusedSecondReturns) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  Frame frame;
  frame.Resize(2, 2, 2);
  std::ranges::fill(frame.range_m, kNaN);
  std::ranges::fill(frame.true_range_m, kNaN);
  frame.range_m[0] = 5.0F;  // The first return of firing 0 and the second of firing 3.
  frame.range_m[7] = 5.0F;
  frame.outcome.assign(8, Outcome::kNoFurtherEcho);
  frame.outcome[2] = Outcome::kNoSurface;
  frame.outcome[4] = Outcome::kNearRange;
  frame.true_range_m[4] = 0.4F;
  const Beams beams{.rows = 2,
                    .columns = 2,
                    .directions = std::vector<Eigen::Vector3f>(4, {0.0F, 1.0F, 0.0F}),
                    .times_ns = std::vector<std::uint32_t>(4)};
  const Overlay drawing = DrawEmptyBeams(Recorded(frame), beams);
  ASSERT_EQ(drawing.segments.size(), 2U);
  EXPECT_EQ(drawing.segments[0].rgb, OutcomeRgb(Outcome::kNoSurface));
  EXPECT_EQ(drawing.segments[1].rgb, OutcomeRgb(Outcome::kNearRange));
  EXPECT_EQ(drawing.segments[1].from_m, Eigen::Vector3f::Zero());
  EXPECT_FLOAT_EQ(drawing.segments[1].to_m.y(), 0.4F);
}

TEST(EmptyBeams, HaveOneColourWhereOutcomesAreNotKnown) {
  const ScanPattern pattern = MakeRaster(30.0, 20.0, 0.5);
  RecordedFrame recorded = ScanTwoWalls(pattern);
  recorded.fields.clear();
  const Overlay drawing = DrawEmptyBeams(recorded, BeamsOf(pattern));
  for (const Overlay::Segment& segment : drawing.segments) {
    ASSERT_EQ(segment.rgb, kUnknownOutcomeRgb);
    ASSERT_NEAR((segment.to_m - segment.from_m).norm(), 10.0F, 1e-5F);
  }
  recorded.is_grid = false;
  EXPECT_THAT(DrawEmptyBeams(recorded, BeamsOf(pattern)).segments, testing::IsEmpty());
}

}  // namespace
}  // namespace railcast
