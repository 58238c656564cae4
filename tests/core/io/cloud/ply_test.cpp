#include "railcast/io/cloud_files.h"

#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <cstring>
#include <string>
#include <vector>

#include "core/io/cloud/cloud_file.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/support/clouds.h"
#include "tests/support/pcl_reads.h"
#include "tests/support/written_file.h"

namespace railcast {
namespace {

std::vector<std::size_t> SlotsWithPoint(const Frame& frame) {
  std::vector<std::size_t> slots;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (HasPoint(frame.outcome[slot])) slots.push_back(slot);
  }
  return slots;
}

template <typename T>
std::vector<T> Column(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  std::vector<T> values;
  for (const pcl::PCLPointField& field : cloud.fields) {
    if (field.name != name) continue;
    for (std::size_t point = 0; point < cloud.width; ++point) {
      T value{};
      std::memcpy(&value, &cloud.data[point * cloud.point_step + field.offset], sizeof value);
      values.push_back(value);
    }
  }
  return values;
}

template <typename T, typename Values>
std::vector<T> Picked(const Frame& frame, const Values& values) {
  std::vector<T> picked;
  for (const std::size_t slot : SlotsWithPoint(frame))
    picked.push_back(static_cast<T>(values[slot]));
  return picked;
}

TEST(EncodePly, GivesPclsReaderItsVelocities) {
  const Frame frame = WithVelocities(ExampleFrame(2));
  const WrittenFile file("frame.ply", PlyBytes(frame, FieldSelection("all", true)));
  const auto by_pcl = PclReads(file.path());
  EXPECT_EQ(Column<float>(by_pcl, "radial_velocity_mps"),
            Picked<float>(frame, frame.radial_velocity_mps));
  EXPECT_EQ(Column<float>(by_pcl, "true_radial_velocity_mps"),
            Picked<float>(frame, frame.true_radial_velocity_mps));
}

TEST(EncodePly, GivesPclsReaderItsPointsAndLabels) {
  const Frame frame = ExampleFrame(2);
  const WrittenFile file("frame.ply", PlyBytes(frame));
  const auto by_pcl = PclReads(file.path());
  for (const pcl::PCLPointCloud2& cloud : {by_pcl, ReadPly(file.path())}) {
    EXPECT_EQ(Column<float>(cloud, "x"), Picked<float>(frame, frame.x));
    EXPECT_EQ(Column<float>(cloud, "intensity"), Picked<float>(frame, frame.intensity));
    EXPECT_EQ(Column<std::uint32_t>(cloud, "time_ns"), Picked<std::uint32_t>(frame, frame.time_ns));
    EXPECT_EQ(Column<std::uint16_t>(cloud, "ring"), Picked<std::uint16_t>(frame, frame.ring));
    EXPECT_EQ(Column<std::uint8_t>(cloud, "outcome"), Picked<std::uint8_t>(frame, frame.outcome));
    EXPECT_EQ(Column<std::uint16_t>(cloud, "material"),
              Picked<std::uint16_t>(frame, frame.material));
  }
  pcl::PointCloud<pcl::PointXYZL> labelled;
  pcl::fromPCLPointCloud2(by_pcl, labelled);
  const auto slots = SlotsWithPoint(frame);
  ASSERT_EQ(labelled.size(), slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i)
    EXPECT_EQ(labelled[i].label, frame.label[slots[i]]);
}

TEST(EncodePly, GivesCloudCompareOnlyTypesThatOpen3dKeepsToo) {
  const std::string bytes = PlyBytes(
      ExampleFrame(0), FieldSelection("x,y,z,intensity,time_ns,ring,label,instance,outcome"),
      PlyFlavour::kCloudCompare);
  EXPECT_EQ(bytes.substr(0, bytes.find("end_header")),
            "ply\nformat binary_little_endian 1.0\nelement vertex 11\n"
            "property float x\nproperty float y\nproperty float z\n"
            "property float scalar_intensity\nproperty double scalar_time_ns\n"
            "property int scalar_ring\nproperty int scalar_label\nproperty int scalar_instance\n"
            "property int scalar_outcome\n");
}

TEST(EncodePly, KeepsTheValuesInTheCloudCompareFlavour) {
  const Frame frame = ExampleFrame(2);
  const WrittenFile file("frame.ply", PlyBytes(frame, {}, PlyFlavour::kCloudCompare));
  for (const auto& cloud : {PclReads(file.path()), ReadPly(file.path())}) {
    EXPECT_EQ(Column<double>(cloud, "scalar_time_ns"), Picked<double>(frame, frame.time_ns));
    EXPECT_EQ(Column<std::int32_t>(cloud, "scalar_label"),
              Picked<std::int32_t>(frame, frame.label));
    EXPECT_EQ(Column<float>(cloud, "scalar_range_m"), Picked<float>(frame, frame.range_m));
  }
}

TEST(EncodePly, RefusesWhatAPlyViewerCannotUse) {
  Frame frame = ExampleFrame(0);
  EXPECT_EQ(MessageOf([&] { (void)PlyBytes(frame, FieldSelection("x,y,label")); }),
            "--fields: a PLY file needs x, y and z (got x,y,label)");
  frame.label[0] = 0x80000000U;
  EXPECT_EQ(MessageOf([&] { (void)PlyBytes(frame, {}, PlyFlavour::kCloudCompare); }),
            "--format ply-cloudcompare: label must be < 2147483648 (got 2147483648)");
}

TEST(EncodePly, AllowsAFrameWithoutAPoint) {
  Frame frame = ExampleFrame(0);
  frame.outcome.assign(frame.num_slots(), Outcome::kNoSurface);
  EXPECT_EQ(ReadPly(WrittenFile("empty.ply", PlyBytes(frame)).path()).width, 0U);
}

TEST(RewrittenPly, KeepsWhatStandsBesideThePoints) {
  const std::string begin = "ply\nformat ascii 1.0\nelement  vertex ";
  const std::string header =
      " \nproperty float x\nproperty uchar label\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string whole = begin + "2" + header + "1.50 2\r\n-3e2  255\n3 0 1 0\n";
  const CloudFile file = ParsePlyFile("a.ply", whole);
  EXPECT_EQ(Rewritten(file, {file.cloud.data, {0, 1}}), std::vector<std::string>{whole});
  const std::vector<std::uint8_t> first(file.cloud.data.begin(), file.cloud.data.begin() + 5);
  EXPECT_EQ(Rewritten(file, {first, {0}}),
            std::vector<std::string>{begin + "1" + header + "1.50 2\r\n3 0 1 0\n"});
}

}  // namespace
}  // namespace railcast
