#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "railcast/io/cloud_files.h"
#include "railcast/io/recording.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/clouds.h"
#include "tests/support/written_file.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::IsNan;

RecordedFrame ReadBytes(const std::string& name, const std::string& bytes) {
  const WrittenFile file(name, bytes);
  const auto recording = OpenRecording(file.path());
  auto frames = ReadAll(*recording);
  EXPECT_EQ(frames.size(), 1U);
  frames.at(0).remarks = recording->info().remarks->List();
  return std::move(frames.at(0));
}

/// Reads an ASCII PLY file whose points have these properties after x, y and z.
/// @param lines One for each point.
RecordedFrame ReadPly(const std::vector<std::string>& properties,
                      const std::vector<std::string>& lines) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(lines.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\n";
  for (const std::string& property : properties) text.append("property ").append(property + "\n");
  text.append("end_header\n");
  for (const std::string& line : lines) text.append(line).append("\n");
  return ReadBytes("a.ply", text);
}

std::vector<std::string> NamesOf(const RecordedFrame& recorded) {
  std::vector<std::string> names;
  for (const ForeignField& field : recorded.foreign) names.push_back(field.name);
  return names;
}

TEST(ForeignFields, HaveNamesOfUtf8) {
  const RecordedFrame recorded = ReadPly({"double h\xF6"
                                          "he",
                                          "float gr\u00fcn"},
                                         {"1 2 3 16777217 7"});
  EXPECT_THAT(NamesOf(recorded), ElementsAre("h\\xf6he", "gr\u00fcn"));
  ASSERT_EQ(recorded.remarks.size(), 1U);
  EXPECT_EQ(recorded.remarks[0].kind, RemarkKind::kValuesRounded);
}

TEST(ForeignFields, AreTheNumbersThatAreNoneOfOursInTheirOrder) {
  const RecordedFrame recorded =
      ReadPly({"float scalar_curvature", "float intensity", "short ambient"},
              {"1 2 3 0.5 7 -1", "0 0 0 0.25 8 -2", "4 5 6 0.125 9 -3"});
  EXPECT_THAT(NamesOf(recorded), ElementsAre("curvature", "ambient"));
  // The second entry is not a point and has no slot.
  EXPECT_THAT(recorded.foreign[0].values, ElementsAre(0.5F, 0.125F));
  EXPECT_THAT(recorded.foreign[1].values, ElementsAre(-1.0F, -3.0F));
  EXPECT_FALSE(recorded.Has("curvature"));
}

TEST(ForeignFields, AreToldOfIfSinglePrecisionCannotHoldThem) {
  const RecordedFrame recorded =
      ReadPly({"double gps_seconds", "uint id", "double curvature"},
              {"1 2 3 331234567.01 16777217 0.1", "4 5 6 331234568 16777218 0.3"});
  EXPECT_THAT(recorded.remarks, ElementsAre(Remark{.kind = RemarkKind::kValuesRounded,
                                                   .place = recorded.name,
                                                   .number = 3,
                                                   .detail = "gps_seconds in steps of 32"}));
}

// The rows are reversed: the lowest comes first.
TEST(ForeignFields, StandInTheSlotsOfTheirPoints) {
  pcl::PointCloud<pcl::PointNormal> cloud(2, 2);
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      pcl::PointNormal& point = cloud.at(column, row);
      point.x = 10.0F;
      point.y = static_cast<float>(column);
      point.z = 1.0F - static_cast<float>(row);
      point.normal_x = point.normal_y = point.normal_z = 0.0F;
      point.curvature = static_cast<float>(10 * row + column);
    }
  }
  cloud.at(1, 0).x = std::numeric_limits<float>::quiet_NaN();
  const TemporaryDirectory directory;
  for (const bool is_binary : {true, false}) {
    const auto file = directory.path() / "a.pcd";
    ASSERT_EQ(pcl::io::savePCDFile(file.string(), cloud, is_binary), 0);
    const auto frames = ReadAll(file);
    EXPECT_THAT(NamesOf(frames.at(0)),
                ElementsAre("normal_x", "normal_y", "normal_z", "curvature"));
    EXPECT_THAT(frames[0].foreign.back().values, ElementsAre(10.0F, 11.0F, 0.0F, IsNan()));
  }
}

TEST(ForeignFields, AreNoColours) {
  EXPECT_THAT(
      ReadPly({"uchar red", "uchar green", "uchar blue", "uchar alpha"}, {"1 2 3 4 5 6 7"}).foreign,
      IsEmpty());
  EXPECT_THAT(ReadPly({"float rgb", "uint rgba"}, {"1 2 3 4 5"}).foreign, IsEmpty());
}

TEST(ForeignFields, ThatAreLeftOutAreTold) {
  const WrittenFile file("a.pcd",
                         "FIELDS x y z rgb normal _\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\n"
                         "COUNT 1 1 1 1 3 1\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1 2 3 4 5 6 7 8\n");
  const auto recording = OpenRecording(file.path());
  (void)ReadAll(*recording);
  EXPECT_THAT(recording->info().remarks->List(),
              ElementsAre(Remark{.kind = RemarkKind::kFieldsLeftOut,
                                 .place = file.path().string(),
                                 .number = 2,
                                 .detail = "rgb, normal but for its first number"}));
}

/// Lines of a turn of 16 rings in a room, with the ring behind each point, and another one for the
/// last.
std::vector<std::string> RingLines(const std::string& last) {
  std::vector<std::string> lines;
  for (int i = 0; i < 180 * 16; ++i) {
    const double azimuth_rad = RadFromDeg(2.0 * (i / 16) + 0.3);
    const double elevation_rad = RadFromDeg(2.0 * (i % 16) - 15.0);
    lines.push_back(std::to_string(9.0 * std::cos(azimuth_rad)) + " " +
                    std::to_string(9.0 * std::sin(azimuth_rad)) + " " +
                    std::to_string(9.0 * std::tan(elevation_rad)) + " " + std::to_string(i % 16));
  }
  lines.back().resize(lines.back().rfind(' ') + 1);
  lines.back() += last;
  return lines;
}

TEST(ForeignFields, AreToldOfRingsThatElevationsReplace) {
  for (const auto& [type, last, got] : std::vector<std::array<std::string, 3>>{
           {"int ring", "15", ""},
           {"int ring", "-1", "ring: must be a whole number from 0 to 65535 (got -1)"},
           {"int laser", "70000", "laser: must be a whole number from 0 to 65535 (got 70000)"},
           {"float ring", "1.5", "ring: must be a whole number from 0 to 65535 (got 1.5)"},
           {"float ring", "nan", "ring: must be a whole number from 0 to 65535 (got nan)"}}) {
    for (const bool is_turn : {true, false}) {
      std::vector<std::string> lines = RingLines(last);
      if (!is_turn) lines.erase(lines.begin(), lines.end() - 3);
      const RecordedFrame recorded = ReadPly({type}, lines);
      EXPECT_EQ(recorded.is_grid, is_turn) << type << last;
      ASSERT_EQ(recorded.remarks.size(), got.empty() ? 0U : 1U) << type << last;
      if (got.empty()) continue;
      EXPECT_EQ(recorded.remarks[0].kind, RemarkKind::kFieldsLeftOut);
      EXPECT_EQ(recorded.remarks[0].number, 1U);
      EXPECT_EQ(recorded.remarks[0].detail, got);
    }
  }
}

TEST(ForeignFields, ThatAreLeftOutAreAllNamed) {
  const RecordedFrame recorded = ReadPly({"int ring", "int label", "float rgb", "uchar intensity"},
                                         {"1 2 3 -1 5 6 7", "1 3 3 0 -2 6 700"});
  EXPECT_THAT(
      recorded.remarks,
      ElementsAre(testing::AllOf(
          testing::Field(&Remark::kind, RemarkKind::kFieldsLeftOut),
          testing::Field(&Remark::number, 4U),
          testing::Field(&Remark::detail, testing::AllOf(testing::HasSubstr("ring: must be"),
                                                         testing::HasSubstr("; label: must be"),
                                                         testing::HasSubstr("intensity: no value"),
                                                         testing::EndsWith("; rgb"))))));
}

TEST(ForeignFields, HoldASecondColumnOfOneMeaning) {
  const RecordedFrame recorded =
      ReadPly({"float reflectivity", "float intensity"}, {"1 2 3 0.25 0.5"});
  EXPECT_EQ(recorded.frame.intensity[0], 0.5F);
  EXPECT_THAT(NamesOf(recorded), ElementsAre("reflectivity"));
  EXPECT_THAT(recorded.foreign[0].values, ElementsAre(0.25F));
  EXPECT_THAT(ReadPly({"float reflectivity"}, {"1 2 3 0.25"}).foreign, IsEmpty());
}

TEST(ForeignFields, AreNotThoseOfAevasSensors) {
  const RecordedFrame recorded =
      ReadPly({"float reflectivity", "float velocity", "uint time_offset_ns", "uchar line_index"},
              {"1 2 3 50 -12.5 1000 2", "2 2 3 60 0.25 2000 3"});
  EXPECT_THAT(recorded.foreign, IsEmpty());
  ASSERT_TRUE(recorded.frame.has_velocity);
  EXPECT_TRUE(recorded.Has("radial_velocity_mps"));
  EXPECT_FALSE(recorded.Has("true_radial_velocity_mps"));
  EXPECT_THAT(recorded.frame.radial_velocity_mps, testing::Contains(-12.5F));
  EXPECT_THAT(recorded.frame.radial_velocity_mps, testing::Contains(0.25F));
  EXPECT_FALSE(ReadPly({"float reflectivity"}, {"1 2 3 50"}).frame.has_velocity);
}

TEST(ForeignFields, HoldATimeOnlyWhereItsUnitIsUncertain) {
  // A span of 0.05 is a scan's duration in seconds; a span of 50 has no certain unit.
  const RecordedFrame certain = ReadPly({"float time"}, {"1 2 3 0", "1 2 4 0.05"});
  EXPECT_TRUE(certain.Has("time_ns"));
  EXPECT_THAT(certain.foreign, IsEmpty());
  const RecordedFrame uncertain = ReadPly({"float time"}, {"1 2 3 0", "1 2 4 50"});
  EXPECT_FALSE(uncertain.Has("time_ns"));
  EXPECT_THAT(NamesOf(uncertain), ElementsAre("time"));
}

TEST(ForeignFields, AreSixtyFourAtMost) {
  std::vector<std::string> properties;
  std::string line = "1 2 3";
  for (int i = 0; i < 70; ++i) {
    properties.push_back("int a" + std::to_string(i));
    line.append(" ").append(std::to_string(i));
  }
  const RecordedFrame recorded = ReadPly(properties, {line});
  ASSERT_EQ(recorded.foreign.size(), 64U);
  EXPECT_EQ(recorded.foreign.back().name, "a63");
  EXPECT_THAT(recorded.foreign.back().values, ElementsAre(63.0F));
}

TEST(ForeignFields, AreNotInFilesOfOurs) {
  const Frame frame = ExampleFrame(3);
  EXPECT_THAT(ReadBytes("a.pcd", PcdBytes(frame)).foreign, IsEmpty());
  EXPECT_THAT(ReadBytes("a.ply", PlyBytes(frame)).foreign, IsEmpty());
  EXPECT_THAT(ReadBytes("a.ply", PlyBytes(frame, {}, PlyFlavour::kCloudCompare)).foreign,
              IsEmpty());
}

}  // namespace
}  // namespace railcast
