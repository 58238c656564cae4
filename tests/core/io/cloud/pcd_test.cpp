#include "railcast/io/cloud_files.h"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <cstring>

#include "core/io/field_layout.h"
#include "core/io/write_file.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

const pcl::PCLPointField* FieldOf(const pcl::PCLPointCloud2& cloud, std::string_view name) {
  for (const pcl::PCLPointField& field : cloud.fields) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

// Whether both have the same bit pattern or are both NaN, since text knows only one NaN.
template <typename T>
bool IsSame(T a, T b) {
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(a) && std::isnan(b)) return true;
  }
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): -0 is not 0 here.
  return std::memcmp(&a, &b, sizeof a) == 0;
}

void ExpectSame(const Frame& frame, const pcl::PCLPointCloud2& cloud) {
  ASSERT_EQ(cloud.width, frame.width());
  ASSERT_EQ(cloud.height, frame.rows);
  ForEachField(frame, [&](std::string_view name, std::string_view, const auto& values) {
    using Stored = typename StoredType<ElementOf<decltype(values)>>::Type;
    const pcl::PCLPointField* field = FieldOf(cloud, name);
    ASSERT_NE(field, nullptr) << name;
    for (std::size_t slot = 0; slot < values.size(); ++slot) {
      Stored stored{};
      std::memcpy(&stored, &cloud.data[slot * cloud.point_step + field->offset], sizeof stored);
      ASSERT_TRUE(IsSame(stored, static_cast<Stored>(values[slot]))) << name << " of slot " << slot;
    }
  });
}

class PcdRoundTrip : public testing::TestWithParam<PcdEncoding> {};

TEST_P(PcdRoundTrip, KeepsEveryBitOfEveryFieldThroughPclsReader) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "frame.pcd";
  const Frame frame = ExampleFrame(3);
  std::string bytes;
  EncodePcd(frame, FieldSelection(), GetParam(), bytes);
  WriteFileWhole(file, bytes);

  pcl::PCLPointCloud2 by_pcl;
  ASSERT_EQ(pcl::io::loadPCDFile(file.string(), by_pcl), 0);
  ExpectSame(frame, by_pcl);
  ExpectSame(frame, ReadPcd(file));
}

TEST_P(PcdRoundTrip, KeepsVelocitiesThroughPclsReader) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "frame.pcd";
  const Frame frame = WithVelocities(ExampleFrame(3));
  std::string bytes;
  EncodePcd(frame, FieldSelection("all", true), GetParam(), bytes);
  WriteFileWhole(file, bytes);

  pcl::PCLPointCloud2 by_pcl;
  ASSERT_EQ(pcl::io::loadPCDFile(file.string(), by_pcl), 0);
  EXPECT_EQ(by_pcl.fields.size(), 21U);
  ExpectSame(frame, by_pcl);
  ExpectSame(frame, ReadPcd(file));
}

TEST_P(PcdRoundTrip, GivesPclsPointXyzlItsLabels) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "frame.pcd";
  const Frame frame = ExampleFrame(3);
  std::string bytes;
  EncodePcd(frame, FieldSelection("x,y,z,label"), GetParam(), bytes);
  WriteFileWhole(file, bytes);

  pcl::PointCloud<pcl::PointXYZL> cloud;
  ASSERT_EQ(pcl::io::loadPCDFile(file.string(), cloud), 0);
  ASSERT_EQ(cloud.size(), frame.num_slots());
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    EXPECT_EQ(cloud[slot].label, frame.label[slot]);
    EXPECT_EQ(std::isnan(cloud[slot].x), !HasPoint(frame.outcome[slot]));
  }
}

INSTANTIATE_TEST_SUITE_P(AllEncodings,
                         PcdRoundTrip,
                         testing::Values(PcdEncoding::kBinary,
                                         PcdEncoding::kBinaryCompressed,
                                         PcdEncoding::kAscii));

TEST(EncodePcd, WritesTheHeaderOtherProgramsExpect) {
  std::string bytes;
  EncodePcd(ExampleFrame(0, 2, 3), FieldSelection("x,y,z,intensity,ring,label,instance,outcome"),
            PcdEncoding::kBinary, bytes);
  const std::string header = bytes.substr(0, bytes.find("DATA"));
  EXPECT_EQ(header,
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
            "FIELDS x y z intensity ring label instance outcome\nSIZE 4 4 4 4 2 4 4 1\n"
            "TYPE F F F F U U U U\nCOUNT 1 1 1 1 1 1 1 1\nWIDTH 3\nHEIGHT 2\n"
            "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 6\n");
}

}  // namespace
}  // namespace railcast
