#include "railcast/io/point_types.h"

#include <gtest/gtest.h>
#include <pcl/common/io.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/io/stream/stream_encoder.h"
#include "railcast/io/cloud_files.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/support/clouds.h"
#include "tests/support/pcl_reads.h"
#include "tests/support/written_file.h"

namespace railcast {
namespace {

template <typename Point>
std::vector<std::string> NamesOf() {
  std::vector<std::string> names;
  for (const pcl::PCLPointField& field : pcl::getFields<Point>()) names.push_back(field.name);
  return names;
}

/// The fields of all points that a type of points has, as bytes.
template <typename Point>
std::vector<std::uint8_t> BytesOf(const pcl::PointCloud<Point>& cloud) {
  std::vector<std::uint8_t> bytes;
  for (const Point& point : cloud) {
    for (const pcl::PCLPointField& field : pcl::getFields<Point>()) {
      const auto* const begin = reinterpret_cast<const std::uint8_t*>(&point) + field.offset;
      bytes.insert(bytes.end(), begin, begin + pcl::getFieldSize(field.datatype));
    }
  }
  return bytes;
}

TEST(PointTypes, HaveTheFieldsOfFilesAndOfStreams) {
  EXPECT_EQ(NamesOf<FramePoint>(), FieldSelection().names());
  std::vector<std::string> names = NamesOf<LabelledPoint>();
  EXPECT_EQ(FieldSelection(kUsualFields).names().size(), names.size());
  for (const std::string& name : names) EXPECT_TRUE(FieldSelection(kUsualFields).Has(name)) << name;
}

TEST(PointTypes, AreWhatPclReadsFromOurFiles) {
  const Frame frame = ExampleFrame(3);
  const WrittenFile file("frame.pcd", PcdBytes(frame, {}, PcdEncoding::kBinaryCompressed));
  const auto read = PclReads<pcl::PointCloud<FramePoint>>(file.path());
  ASSERT_EQ(read.size(), frame.num_slots());
  EXPECT_EQ(read[7].outcome, static_cast<std::uint8_t>(frame.outcome[7]));
  EXPECT_EQ(read[8].instance, frame.instance[8]);
  EXPECT_EQ(read[9].material, frame.material[9]);
  EXPECT_EQ(BytesOf(read), BytesOf(ToPointCloud<FramePoint>(frame)));
  pcl::PointCloud<LabelledPoint> labelled;
  pcl::fromPCLPointCloud2(ReadPcd(file.path()), labelled);
  EXPECT_EQ(BytesOf(labelled), BytesOf(ToPointCloud<LabelledPoint>(frame)));
}

TEST(ToPointCloud, IsOrganisedAsTheFrame) {
  const Frame frame = ExampleFrame(4);
  const auto cloud = ToPointCloud<pcl::PointXYZL>(frame);
  EXPECT_EQ(cloud.width, frame.width());
  EXPECT_EQ(cloud.height, frame.rows);
  EXPECT_EQ(cloud.header.stamp, 400'000U);
  EXPECT_EQ(cloud.header.seq, 4U);
  EXPECT_FALSE(cloud.is_dense);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    EXPECT_EQ(cloud[slot].label, frame.label[slot]);
    EXPECT_EQ(std::isnan(cloud[slot].x), std::isnan(frame.x[slot]));
  }
}

TEST(ToPointCloud, NamesAFieldThatFramesDoNotHave) {
  EXPECT_EQ(MessageOf([] { (void)ToPointCloud<pcl::PointXYZRGB>(ExampleFrame(0)); }),
            "a cloud of points: frames must have its field rgb with that type");
}

}  // namespace
}  // namespace railcast
