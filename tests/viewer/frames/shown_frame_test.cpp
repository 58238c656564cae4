#include "viewer/frames/shown_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/io/cloud/scan_motion.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/core/io/stream/stream_example.h"

namespace railcast {
namespace {

using testing::ElementsAreArray;

/// A frame with every field, of 4800 firings, two of ten with a point, during which the sensor
/// moved by 3 m and turned by 0.1 rad.
RecordedFrame MovingFrame() {
  Frame frame = StreamFrame(3);
  frame.world_from_sensor_end =
      frame.world_from_sensor *
      MakeTransform(RotationFromYawPitchRoll(0.1, 0.0, 0.02), Vector3(3.0, 0.15, 0.0));
  return Record(std::move(frame));
}

/// Returns the recorded positions of all slots that have a point.
std::vector<float> RecordedPositions(const Frame& frame) {
  std::vector<float> positions_m;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.x[slot])) continue;
    for (const auto* axis : {&frame.x, &frame.y, &frame.z}) positions_m.push_back((*axis)[slot]);
  }
  return positions_m;
}

TEST(ShownFrame, HasThePointsOfAllSlotsThatHaveOne) {
  const RecordedFrame recorded = MovingFrame();
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < recorded.frame.num_slots(); ++slot) {
    if (HasPoint(recorded.frame.outcome[slot])) slots.push_back(slot);
  }
  const ShownFrame shown = MakeShownFrame(recorded);
  EXPECT_EQ(shown.slots, slots);
  EXPECT_EQ(shown.positions_m.size(), 3 * slots.size());
  EXPECT_EQ(shown.num_points(), slots.size());
  EXPECT_EQ(shown.recorded->fields, recorded.fields);
}

TEST(ShownFrame, PutsPointsWhereTheyWereAtTheStamp) {
  const ShownFrame shown = MakeShownFrame(MovingFrame());
  const Frame& frame = shown.frame();
  const ScanMotion motion(frame);
  double furthest_m = 0.0;
  for (std::size_t i = 0; i < shown.num_points(); ++i) {
    const std::uint32_t slot = shown.slots[i];
    const Vector3 seen_m =
        Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]).cast<double>();
    const Eigen::Vector3f expected_m = motion.AtStamp(seen_m, frame.time_ns[slot]).cast<float>();
    const Eigen::Map<const Eigen::Vector3f> shown_m(&shown.positions_m[3 * i]);
    ASSERT_EQ(expected_m, shown_m) << i;
    furthest_m = std::max(furthest_m, (seen_m - shown_m.cast<double>()).norm());
  }
  // The sensor moves by 3 m until the last firings, and 0.1 rad at 300 m is 30 m.
  EXPECT_GT(furthest_m, 3.0);
}

TEST(ShownFrame, PutsPointsOfMovingObjectsWhereTheirBoxesAre) {
  RecordedFrame recorded = MovingFrame();
  const std::vector<float> standing_m = MakeShownFrame(recorded).positions_m;
  recorded.frame.instance.assign(recorded.frame.num_slots(), 5);
  recorded.objects = {{.name = "wagon",
                       .type = "open_wagon",
                       .label = "wagon",
                       .instance = 5,
                       .velocity_world_mps = Vector3(-20.0, 10.0, 0.0)}};
  const ShownFrame shown = MakeShownFrame(recorded);
  const Frame& frame = shown.frame();
  for (std::size_t i = 0; i < shown.num_points(); ++i) {
    const std::uint32_t slot = shown.slots[i];
    const double time_s =
        frame.outcome[slot] == Outcome::kClutter ? 0.0 : 1e-9 * frame.time_ns[slot];
    const Vector3 way_m =
        frame.world_from_sensor.linear().transpose() * Vector3(-20.0 * time_s, 10.0 * time_s, 0.0);
    const Vector3 moved_m =
        Eigen::Map<const Eigen::Vector3f>(&standing_m[3 * i]).cast<double>() -
        Eigen::Map<const Eigen::Vector3f>(&shown.positions_m[3 * i]).cast<double>();
    // Rounding of float32 at 300 m.
    ASSERT_LT((moved_m - way_m).norm(), 1e-4) << i;
  }
}

TEST(ShownFrame, LeavesPointsWhereTheyAreIfTheMotionIsNotKnown) {
  RecordedFrame without_times = MovingFrame();
  without_times.fields.erase("time_ns");
  RecordedFrame without_pose = MovingFrame();
  without_pose.has_pose = false;
  RecordedFrame of_one_moment = MovingFrame();
  of_one_moment.frame.duration_ns = 0;
  for (const RecordedFrame& recorded : {without_times, without_pose, of_one_moment}) {
    EXPECT_THAT(MakeShownFrame(recorded).positions_m,
                ElementsAreArray(RecordedPositions(recorded.frame)));
  }
}

TEST(ShownFrame, MayHaveNoPoints) {
  EXPECT_EQ(MakeShownFrame({}).num_points(), 0U);
}

}  // namespace
}  // namespace railcast
