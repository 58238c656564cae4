#include "core/io/stream/stream_clouds.h"

#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include "tests/core/io/stream/stream_example.h"

namespace railcast {
namespace {

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
  StreamSpec spec;
  spec.fields = FieldSelection("x,y,z");
  spec.has_all_slots = true;
  EXPECT_FALSE(MakePclCloud(ReceiveWhole(StreamFrame(0), spec)).is_dense);
}

}  // namespace
}  // namespace railcast
