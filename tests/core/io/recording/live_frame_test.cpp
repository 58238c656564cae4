#include "core/io/recording/live_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/io/recording/firing_truth.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/stream/stream_example.h"

namespace railcast {
namespace {

using testing::UnorderedElementsAre;

StreamSpec Sending(const char* fields, bool has_all_slots = false) {
  StreamSpec spec;
  spec.fields = FieldSelection(fields);
  spec.has_all_slots = has_all_slots;
  return spec;
}

StreamSpec SendingIn(OutputFrame axes, Handedness handedness) {
  StreamSpec spec = Sending("x,y,z,ring,column");
  spec.output.frame = axes;
  spec.output.handedness = handedness;
  return spec;
}

/// Equal floats, or both NaN.
MATCHER(IsSame, "") {
  const auto& [a, b] = arg;
  return a == b || (std::isnan(a) && std::isnan(b));
}

RecordedFrame Live(const Frame& frame, const StreamSpec& spec) {
  return MakeLiveFrame(ReceiveWhole(frame, spec), "live");
}

/// Returns what arrives of a frame without its last datagram.
ReceivedFrame ReceivePart(const Frame& frame, const StreamSpec& spec) {
  FrameAssembler assembler;
  auto datagrams = DatagramsOf(frame, spec);
  datagrams.pop_back();
  auto frames = Feed(assembler, datagrams);
  assembler.Flush(frames);
  return frames.at(0);
}

TEST(LiveFrame, IsTheSendersFrameWhereEverySlotArrived) {
  const Frame frame = StreamFrame(3);
  const RecordedFrame live = Live(
      frame, Sending("x,y,z,ring,column,outcome,label,time_ns,range_m,intensity,material", true));
  EXPECT_TRUE(live.is_grid);
  EXPECT_TRUE(live.has_pose);
  EXPECT_EQ(live.name, "live");
  EXPECT_THAT(live.fields, UnorderedElementsAre("x", "y", "z", "ring", "column", "outcome", "label",
                                                "time_ns", "range_m", "intensity", "material",
                                                "return_index", "return_count"));
  EXPECT_EQ(live.frame.rows, frame.rows);
  EXPECT_EQ(live.frame.columns, frame.columns);
  EXPECT_EQ(live.frame.outcome, frame.outcome);
  EXPECT_EQ(live.frame.label, frame.label);
  EXPECT_EQ(live.frame.time_ns, frame.time_ns);
  EXPECT_EQ(live.frame.material, frame.material);
  EXPECT_EQ(live.frame.ring, frame.ring);
  EXPECT_EQ(live.frame.column, frame.column);
  EXPECT_EQ(live.frame.return_count, frame.return_count);
  EXPECT_THAT(live.frame.x, testing::Pointwise(IsSame(), frame.x));
  EXPECT_THAT(live.frame.range_m, testing::Pointwise(IsSame(), frame.range_m));
  EXPECT_THAT(live.frame.intensity, testing::Pointwise(IsSame(), frame.intensity));
}

TEST(LiveFrame, SaysWhenAndFromWhere) {
  const Frame frame = StreamFrame(3);
  const RecordedFrame live = Live(frame, Sending("x,y,z"));
  EXPECT_EQ(live.frame.index, 3U);
  EXPECT_EQ(live.frame.stamp_ns, frame.stamp_ns);
  EXPECT_EQ(live.frame.duration_ns, frame.duration_ns);
  // Poses are converted to a quaternion of doubles and back.
  EXPECT_TRUE(live.frame.world_from_sensor.isApprox(frame.world_from_sensor, 1e-14));
  EXPECT_TRUE(live.frame.world_from_sensor_end.isApprox(frame.world_from_sensor_end, 1e-14));
}

TEST(LiveFrame, HasAGridOfWhatReturnedIfOnlyThatWasSent) {
  const Frame frame = StreamFrame(1);
  const RecordedFrame live = Live(frame, Sending("x,y,z,ring,column,outcome"));
  EXPECT_TRUE(live.is_grid);
  EXPECT_EQ(live.frame.rows, frame.rows);
  EXPECT_EQ(live.frame.columns, frame.columns);
  EXPECT_THAT(live.frame.y, testing::Pointwise(IsSame(), frame.y));
  EXPECT_EQ(live.frame.return_count, frame.return_count);
  // The stream did not say why the other firings did not return.
  EXPECT_TRUE(live.Has("outcome"));
  EXPECT_FALSE(HasAllOutcomes(live));
  EXPECT_FALSE(live.Has("time_ns"));
}

TEST(LiveFrame, ComputesRangesThatWereNotSent) {
  const RecordedFrame live = Live(StreamFrame(1), Sending("x,y,z"));
  EXPECT_TRUE(live.Has("range_m"));
  ASSERT_GT(live.frame.num_slots(), 0U);
  for (std::size_t i = 0; i < live.frame.num_slots(); ++i) {
    EXPECT_FLOAT_EQ(live.frame.range_m[i],
                    std::hypot(live.frame.x[i], live.frame.y[i], live.frame.z[i]));
  }
}

TEST(LiveFrame, IsOneRowOfThePointsIfTheirPlacesWereNotSent) {
  const Frame frame = StreamFrame(1);
  for (const bool all : {false, true}) {
    for (const char* fields : {"x,y,z,label", "x,y,z,ring,label", "x,y,z,column,label"}) {
      const RecordedFrame live = Live(frame, Sending(fields, all));
      EXPECT_FALSE(live.is_grid);
      EXPECT_EQ(live.frame.rows, 1U);
      EXPECT_EQ(live.frame.num_slots(),
                static_cast<std::size_t>(std::ranges::count_if(frame.outcome, HasPoint)));
      EXPECT_TRUE(live.Has("label"));
    }
  }
}

TEST(LiveFrame, IsOneRowOfThePointsThatArrivedIfSomeWereLost) {
  const Frame frame = StreamFrame(1);
  const ReceivedFrame received =
      ReceivePart(frame, Sending("x,y,z,ring,column,outcome,label", true));
  const RecordedFrame live = MakeLiveFrame(received, "live");
  EXPECT_FALSE(live.is_grid);
  EXPECT_TRUE(live.has_pose);
  EXPECT_LT(live.frame.num_slots(), received.num_points());
  ASSERT_GT(live.frame.num_slots(), 0U);
  for (std::size_t i = 0; i < live.frame.num_slots(); ++i) {
    const std::size_t slot = live.frame.ring[i] * std::size_t{frame.columns} + live.frame.column[i];
    ASSERT_EQ(live.frame.x[i], frame.x[slot]);
    ASSERT_EQ(live.frame.label[i], frame.label[slot]);
    ASSERT_EQ(live.frame.outcome[i], frame.outcome[slot]);
  }
}

TEST(LiveFrame, PutsTheReturnsOfAFiringBesideEachOther) {
  Frame frame = StreamFrame(1, 4, 2);
  // Declare the same slots as two returns of half as many firings.
  frame.columns = 1;
  frame.returns = 2;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    frame.column[slot] = 0;
    frame.return_index[slot] = static_cast<std::uint8_t>(slot % 2);
  }
  const RecordedFrame live = Live(frame, Sending("x,y,z,ring,column,return_index,label", true));
  EXPECT_TRUE(live.is_grid);
  EXPECT_EQ(live.frame.returns, 2U);
  EXPECT_EQ(live.frame.label, frame.label);
  EXPECT_FALSE(Live(frame, Sending("x,y,z,ring,column,label", true)).is_grid);
}

TEST(LiveFrame, MakesLeftHandedAxesRightHanded) {
  Frame sent = StreamFrame(1);
  const Frame frame = sent;
  for (float& y : sent.y) y = -y;
  const RecordedFrame live = Live(sent, SendingIn(OutputFrame::kSensor, Handedness::kLeft));
  EXPECT_TRUE(live.has_pose);
  EXPECT_THAT(live.frame.y, testing::Pointwise(IsSame(), frame.y));
  EXPECT_THAT(live.frame.x, testing::Pointwise(IsSame(), frame.x));
}

TEST(LiveFrame, HasNoPoseForPointsInOtherAxes) {
  const Frame frame = StreamFrame(1);
  for (const OutputFrame axes : {OutputFrame::kVehicle, OutputFrame::kWorld}) {
    const RecordedFrame live = Live(frame, SendingIn(axes, Handedness::kRight));
    EXPECT_FALSE(live.has_pose);
    EXPECT_THAT(live.frame.x, testing::Pointwise(IsSame(), frame.x));
    EXPECT_FALSE(live.Has("range_m"));
    EXPECT_TRUE(std::ranges::all_of(live.frame.range_m, [](float r) { return std::isnan(r); }));
    StreamSpec with_ranges = SendingIn(axes, Handedness::kRight);
    with_ranges.fields = FieldSelection("x,y,z,range_m");
    EXPECT_TRUE(Live(frame, with_ranges).Has("range_m"));
  }
}

TEST(LiveFrame, MayBeWithoutAnyPoint) {
  Frame frame = StreamFrame(2);
  std::ranges::fill(frame.outcome, Outcome::kNoSurface);
  for (auto* values : {&frame.x, &frame.y, &frame.z, &frame.range_m}) {
    std::ranges::fill(*values, std::numeric_limits<float>::quiet_NaN());
  }
  const RecordedFrame loose = Live(frame, Sending("x,y,z"));
  EXPECT_FALSE(loose.is_grid);
  EXPECT_EQ(loose.frame.num_slots(), 0U);
  EXPECT_EQ(loose.frame.index, 2U);
  const RecordedFrame grid = Live(frame, Sending("x,y,z,ring,column"));
  EXPECT_TRUE(grid.is_grid);
  EXPECT_EQ(grid.frame.num_slots(), frame.num_slots());
  EXPECT_TRUE(std::ranges::all_of(grid.frame.x, [](float x) { return std::isnan(x); }));
}

TEST(LiveFrame, TakesNoMoreMemoryThanWhatArrivedIsWorth) {
  ReceivedFrame received = ReceiveWhole(StreamFrame(1, 2, 4), Sending("x,y,z,ring,column"));
  for (const std::uint32_t columns : {1U << 20U, 0xFFFFFFFFU}) {
    received.header.columns = columns;
    const RecordedFrame live = MakeLiveFrame(received, "live");
    EXPECT_FALSE(live.is_grid);
    EXPECT_EQ(live.frame.num_slots(), received.num_points());
  }
}

TEST(LiveFrame, RefusesWhatIsNoPointOrNoSlot) {
  Frame frame = StreamFrame(1, 2, 4);
  EXPECT_EQ(MessageOf([&] { (void)Live(frame, Sending("x,y,ring", true)); }),
            "live: has no field z");
  frame.column[3] = 2;
  EXPECT_EQ(MessageOf([&] { (void)Live(frame, Sending("x,y,z,ring,column", true)); }),
            "live: point 6: must be the only one of its ring, column and return_index (got 0, 2, "
            "0)");
  frame.column[3] = 4;
  EXPECT_EQ(MessageOf([&] { (void)Live(frame, Sending("x,y,z,ring,column", true)); }),
            "live: column: must be a whole number from 0 to 3 (got 4)");
}

TEST(LiveFrame, HasTheVelocitiesThatWereSent) {
  const Frame frame = WithVelocities(StreamFrame(1));
  StreamSpec spec;
  spec.has_all_slots = true;
  EXPECT_FALSE(Live(frame, spec).frame.has_velocity);
  spec.fields = FieldSelection("all", true);
  const Frame live = Live(frame, spec).frame;
  ASSERT_TRUE(live.has_velocity);
  EXPECT_EQ(live.true_radial_velocity_mps, frame.true_radial_velocity_mps);
  EXPECT_THAT(live.radial_velocity_mps, testing::Pointwise(IsSame(), frame.radial_velocity_mps));
}

}  // namespace
}  // namespace railcast
