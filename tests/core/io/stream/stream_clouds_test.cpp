#include "core/io/stream/stream_clouds.h"

#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <cmath>

#include "tests/core/io/stream/stream_example.h"

namespace railcast {
namespace {

StreamSpec AllSlotsOf(const char* fields) {
  StreamSpec spec;
  spec.fields = FieldSelection(fields);
  spec.has_all_slots = true;
  return spec;
}

TEST(MakePclCloud, HoldsEveryFieldByItsName) {
  StreamSpec spec;
  spec.fields = FieldSelection();
  spec.sensor = 2;
  const ReceivedFrame received = ReceiveWhole(StreamFrame(7), spec);
  const pcl::PCLPointCloud2 cloud = MakePclCloud(received);
  EXPECT_EQ(cloud.header.seq, 7U);
  EXPECT_EQ(cloud.header.stamp, 700'000U);  // Frame 7 at 10 Hz, in microseconds.
  EXPECT_EQ(cloud.header.frame_id, "railcast_2");
  EXPECT_EQ(cloud.width, received.num_points());
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_TRUE(cloud.is_dense);
  EXPECT_EQ(cloud.fields.size(), 19U);
  pcl::PointCloud<pcl::PointXYZL> points;
  pcl::fromPCLPointCloud2(cloud, points);
  ASSERT_EQ(points.size(), received.num_points());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].y, received.At<float>(*received.header.Find("y"), i));
    EXPECT_EQ(points[i].label, received.At<std::uint32_t>(*received.header.Find("label"), i));
  }
}

TEST(MakePclCloud, SaysWhereSlotsHaveNoPoint) {
  EXPECT_FALSE(MakePclCloud(ReceiveWhole(StreamFrame(0), AllSlotsOf("x,y,z"))).is_dense);
}

TEST(MakeFrame, LeavesFieldsThatWereNotSentEmpty) {
  const Frame frame = StreamFrame(1);
  const auto made = MakeFrame(ReceiveWhole(frame, AllSlotsOf("range_m,ring,column,outcome")));
  ASSERT_TRUE(made);
  EXPECT_EQ(made->column, frame.column);
  EXPECT_EQ(made->outcome, frame.outcome);
  EXPECT_TRUE(std::isnan(made->intensity[5]));
  EXPECT_EQ(made->label[5], 0U);
}

TEST(MakeFrame, HasTheVelocitiesThatWereSent) {
  const Frame frame = WithVelocities(StreamFrame(1));
  StreamSpec spec = AllSlotsOf("ring,column,outcome");
  EXPECT_FALSE(MakeFrame(ReceiveWhole(StreamFrame(1), spec))->has_velocity);
  spec.fields = FieldSelection("all", true);
  const auto made = MakeFrame(ReceiveWhole(frame, spec));
  ASSERT_TRUE(made);
  ASSERT_TRUE(made->has_velocity);
  EXPECT_EQ(made->true_radial_velocity_mps, frame.true_radial_velocity_mps);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    EXPECT_EQ(std::isnan(made->radial_velocity_mps[slot]), !HasPoint(frame.outcome[slot]));
  }
}

TEST(MakeFrame, MakesNoneOfWhatIsNotAWholeFrame) {
  const Frame frame = StreamFrame(1);
  const auto makes = [&](const StreamSpec& spec) {
    return MakeFrame(ReceiveWhole(frame, spec)).has_value();
  };
  EXPECT_TRUE(makes(AllSlotsOf("ring,column,outcome")));
  EXPECT_FALSE(makes(AllSlotsOf("ring,column")));
  EXPECT_FALSE(makes(AllSlotsOf("ring,outcome")));
  EXPECT_FALSE(makes(AllSlotsOf("column,outcome")));
  EXPECT_FALSE(makes({}));
  FrameAssembler assembler;
  auto datagrams = DatagramsOf(frame, AllSlotsOf("ring,column,outcome"));
  datagrams.pop_back();
  auto frames = Feed(assembler, datagrams);
  assembler.Flush(frames);
  EXPECT_FALSE(MakeFrame(frames.at(0)));
}

TEST(MakeFrame, MakesNoneOfSlotsAndOutcomesThatDoNotExist) {
  Frame frame = StreamFrame(1);
  const StreamSpec spec = AllSlotsOf("ring,column,outcome");
  const auto makes = [&] { return MakeFrame(ReceiveWhole(frame, spec)).has_value(); };
  EXPECT_TRUE(makes());
  frame.column[3] = frame.columns;
  EXPECT_FALSE(makes());
  frame.column[3] = frame.column[4];
  EXPECT_FALSE(makes());
  frame.column[3] = 3;
  EXPECT_TRUE(makes());
  frame.outcome[3] = static_cast<Outcome>(11);
  EXPECT_FALSE(makes());
}

}  // namespace
}  // namespace railcast
