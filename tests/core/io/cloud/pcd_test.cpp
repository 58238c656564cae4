#include "railcast/io/cloud_files.h"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <cstring>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/io/cloud/cloud_file.h"
#include "core/io/cloud/pcd_encoder.h"
#include "core/io/field_layout.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/clouds.h"
#include "tests/support/pcl_reads.h"
#include "tests/support/written_file.h"

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
  const Frame frame = ExampleFrame(3);
  const WrittenFile file("frame.pcd", PcdBytes(frame, {}, GetParam()));
  ExpectSame(frame, PclReads(file.path()));
  ExpectSame(frame, ReadPcd(file.path()));
}

TEST_P(PcdRoundTrip, KeepsVelocitiesThroughPclsReader) {
  const Frame frame = WithVelocities(ExampleFrame(3));
  const WrittenFile file("frame.pcd", PcdBytes(frame, FieldSelection("all", true), GetParam()));
  const auto by_pcl = PclReads(file.path());
  EXPECT_EQ(by_pcl.fields.size(), 21U);
  ExpectSame(frame, by_pcl);
  ExpectSame(frame, ReadPcd(file.path()));
}

TEST_P(PcdRoundTrip, GivesPclsPointXyzlItsLabels) {
  const Frame frame = ExampleFrame(3);
  const WrittenFile file("frame.pcd", PcdBytes(frame, FieldSelection("x,y,z,label"), GetParam()));
  const auto cloud = PclReads<pcl::PointCloud<pcl::PointXYZL>>(file.path());
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
  const std::string bytes = PcdBytes(ExampleFrame(0, 2, 3),
                                     FieldSelection("x,y,z,intensity,ring,label,instance,outcome"));
  const std::string header = bytes.substr(0, bytes.find("DATA"));
  EXPECT_EQ(header,
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
            "FIELDS x y z intensity ring label instance outcome\nSIZE 4 4 4 4 2 4 4 1\n"
            "TYPE F F F F U U U U\nCOUNT 1 1 1 1 1 1 1 1\nWIDTH 3\nHEIGHT 2\n"
            "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 6\n");
}

/// A cloud with fields of all types, and of several numbers.
Cloud OwnCloud(const pcl::PCLPointCloud2& cloud) {
  Cloud own;
  for (const pcl::PCLPointField& field : cloud.fields) {
    own.AddField(field.name, static_cast<NumberType>(field.datatype), field.count);
  }
  own.width = cloud.width;
  own.height = cloud.height;
  own.data = cloud.data;
  return own;
}

pcl::PCLPointCloud2 CloudOfAllTypes() {
  pcl::PCLPointCloud2 cloud;
  for (const auto& [type, count] : std::vector<std::pair<std::uint8_t, std::uint32_t>>{{7, 1},
                                                                                       {7, 3},
                                                                                       {8, 1},
                                                                                       {1, 1},
                                                                                       {2, 2},
                                                                                       {3, 1},
                                                                                       {4, 1},
                                                                                       {5, 1},
                                                                                       {6, 1},
                                                                                       {9, 1},
                                                                                       {10, 1}}) {
    pcl::PCLPointField field;
    field.name = "field" + std::to_string(cloud.fields.size());
    field.offset = cloud.point_step;
    field.datatype = type;
    field.count = count;
    cloud.point_step += count * static_cast<std::uint32_t>(pcl::getFieldSize(type));
    cloud.fields.push_back(field);
  }
  cloud.width = 50;
  cloud.height = 4;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.is_dense = 1;
  cloud.data.resize(std::size_t{cloud.height} * cloud.row_step);
  for (std::size_t i = 0; i < cloud.data.size(); ++i) {
    // Floats and doubles of moderate size.
    cloud.data[i] = static_cast<std::uint8_t>(i % 4 == 3 ? 0x3D + i / 4 % 4 : i * i % 97);
  }
  return cloud;
}

void ExpectSameCloud(const pcl::PCLPointCloud2& one, const pcl::PCLPointCloud2& other) {
  EXPECT_EQ(one.width, other.width);
  EXPECT_EQ(one.height, other.height);
  EXPECT_EQ(one.point_step, other.point_step);
  EXPECT_EQ(one.row_step, other.row_step);
  EXPECT_EQ(one.is_dense, other.is_dense);
  EXPECT_EQ(one.data, other.data);
  ASSERT_EQ(one.fields.size(), other.fields.size());
  for (std::size_t i = 0; i < one.fields.size(); ++i) {
    EXPECT_EQ(one.fields[i].name, other.fields[i].name);
    EXPECT_EQ(one.fields[i].offset, other.fields[i].offset);
    EXPECT_EQ(one.fields[i].datatype, other.fields[i].datatype);
    EXPECT_EQ(one.fields[i].count, other.fields[i].count);
  }
}

TEST(ReadPcd, GivesTheCloudsThatPclWritesAndReads) {
  const TemporaryDirectory directory;
  const pcl::PCLPointCloud2 cloud = CloudOfAllTypes();
  pcl::PCLPointCloud2 with_nan = cloud;
  with_nan.is_dense = 0;
  StoreAt<float>(reinterpret_cast<char*>(with_nan.data.data()) + 8,
                 std::numeric_limits<float>::quiet_NaN());
  const Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  pcl::PCDWriter writer;
  for (const pcl::PCLPointCloud2* written :
       std::initializer_list<const pcl::PCLPointCloud2*>{&cloud, &with_nan}) {
    const auto file = [&](const std::string& name) { return (directory.path() / name).string(); };
    // Enough digits for any double.
    ASSERT_EQ(writer.writeASCII(file("ascii.pcd"), *written, origin, orientation, 17), 0);
    ASSERT_EQ(writer.writeBinary(file("binary.pcd"), *written, origin, orientation), 0);
    ASSERT_EQ(writer.writeBinaryCompressed(file("lzf.pcd"), *written, origin, orientation), 0);
    for (const std::string name : {"ascii.pcd", "binary.pcd", "lzf.pcd"}) {
      SCOPED_TRACE(name);
      ExpectSameCloud(ReadPcd(file(name)), *written);
      const auto by_pcl = PclReads(file(name));
      // PCL 1.13 takes 64-bit integers in text for something else.
      if (name == "ascii.pcd") continue;
      ExpectSameCloud(by_pcl, *written);
    }
  }
}

TEST(EncodePcd, WritesCloudsThatPclReads) {
  const pcl::PCLPointCloud2 cloud = CloudOfAllTypes();
  const Cloud own = OwnCloud(cloud);
  for (const bool is_compressed : {false, true}) {
    const std::string bytes = EncodePcd(own, is_compressed);
    EXPECT_EQ(EncodePcd(own, is_compressed), bytes);
    ExpectSameCloud(PclReads(WrittenFile("cloud.pcd", bytes).path()), cloud);
    const std::string data = is_compressed ? "binary_compressed" : "binary";
    pcl::PCDWriter writer;
    EXPECT_EQ(PcdHeaderOf(own, data), writer.generateHeaderBinary(cloud, Eigen::Vector4f::Zero(),
                                                                  Eigen::Quaternionf::Identity()) +
                                          "DATA " + data + "\n");
  }
}

TEST(RewrittenPcd, KeepsTheWordsOfNumbersThatStay) {
  const CloudFile file = ParsePcdFile("a.pcd",
                                      "FIELDS x n\nSIZE 4 2\nTYPE F I\nCOUNT 1 2\n WIDTH 2 \n"
                                      "HEIGHT 1\nPOINTS 2\nDATA ascii\n1.50 7 8\nnan -1 9");
  OtherPoints points{file.cloud.data, {0, 1, kNoSource}};
  StoreAt<std::int16_t>(reinterpret_cast<char*>(points.data.data()) + 6, -5);
  StoreAt<float>(reinterpret_cast<char*>(points.data.data()) + 8, 0.25F);
  points.data.resize(points.data.size() + file.cloud.point_step);
  EXPECT_EQ(Rewritten(file, points),
            std::vector<std::string>{"FIELDS x n\nSIZE 4 2\nTYPE F I\nCOUNT 1 2\n WIDTH 3 \n"
                                     "HEIGHT 1\nPOINTS 3\nDATA ascii\n1.50 7 -5\n0.25 -1 9\n"
                                     "0 0 0\n"});
}

}  // namespace
}  // namespace railcast
