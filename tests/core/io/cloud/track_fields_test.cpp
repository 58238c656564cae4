#include "core/io/cloud/track_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>

#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/extras/ros/messages/point_layout.h"
#include "core/io/write_file.h"
#include "railcast/io/recording.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/rail/world/made_track.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::FloatNear;
using testing::IsNan;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
// The points are float32, at most 50 m from the origin of their axes: 4e-6 m; chainages of 500 m
// are stored to 3e-5 m.
constexpr float kFloat_m = 1e-4F;

/// Where the points of MadeFrame() are on the straight track: chainage, lateral and height. The
/// fourth slot has none.
const std::vector<Vector3> kPlaces_m = {{510.0, 0.0, 1.0}, {512.0, -1.5, 0.5}, {514.0, 3.0, 2.0}};

/// The output as the points of MadeFrame() are in.
struct MadeAxes {
  OutputSpec output;
  Transform vehicle_from_sensor =
      MakeTransform(RotationFromYawPitchRoll(0.2, 0.1, 0.0), Vector3(1.0, 0.0, 2.5));
};

/// A scan of 0.1 s by a sensor that moves from 500 to 504 m, with a point every 25 ms.
Frame MadeFrame(const MadeAxes& axes) {
  Frame frame;
  frame.Resize(1, 4, 1);
  frame.duration_ns = 100'000'000;
  const auto world_from_vehicle = [](double share) {
    return MakeTransform(Eigen::Matrix3d::Identity(), Vector3(500.0 + 4.0 * share, 0.0, 0.0));
  };
  frame.world_from_sensor = world_from_vehicle(0.0) * axes.vehicle_from_sensor;
  frame.world_from_sensor_end = world_from_vehicle(1.0) * axes.vehicle_from_sensor;
  for (std::size_t slot = 0; slot < 4; ++slot) {
    frame.x[slot] = frame.y[slot] = frame.z[slot] = kNaN;
    frame.outcome[slot] = Outcome::kNoSurface;
    if (slot == kPlaces_m.size()) continue;
    const double share = 0.25 * static_cast<double>(slot);
    frame.time_ns[slot] = static_cast<std::uint32_t>(share * frame.duration_ns);
    Vector3 point_m = kPlaces_m[slot];
    if (axes.output.frame != OutputFrame::kWorld) {
      point_m = world_from_vehicle(share).inverse() * point_m;
    } else {
      point_m -= Vector3(axes.output.origin_m.data());
    }
    if (axes.output.frame == OutputFrame::kSensor) {
      point_m = axes.vehicle_from_sensor.inverse() * point_m;
    }
    if (axes.output.handedness == Handedness::kLeft) point_m.y() = -point_m.y();
    frame.x[slot] = static_cast<float>(point_m.x());
    frame.y[slot] = static_cast<float>(point_m.y());
    frame.z[slot] = static_cast<float>(point_m.z());
    frame.outcome[slot] = Outcome::kReturned;
  }
  return frame;
}

std::shared_ptr<const FrameTrack> TrackOf(const MadeAxes& axes) {
  return std::make_shared<const FrameTrack>(
      FrameTrack{StraightTrack(), axes.output, axes.vehicle_from_sensor});
}

void ExpectMadePlaces(const TrackFields& fields) {
  EXPECT_THAT(fields.chainage_m,
              ElementsAre(FloatNear(510.0F, kFloat_m), FloatNear(512.0F, kFloat_m),
                          FloatNear(514.0F, kFloat_m), IsNan()));
  EXPECT_THAT(fields.track_lateral_m,
              ElementsAre(FloatNear(0.0F, kFloat_m), FloatNear(-1.5F, kFloat_m),
                          FloatNear(3.0F, kFloat_m), IsNan()));
  EXPECT_THAT(fields.track_height_m,
              ElementsAre(FloatNear(1.0F, kFloat_m), FloatNear(0.5F, kFloat_m),
                          FloatNear(2.0F, kFloat_m), IsNan()));
  EXPECT_THAT(fields.in_gauge, ElementsAre(1, 1, 0, 0));
}

TEST(TrackFields, AreOfThePlaceWhereEachFiringMetItsSurface) {
  const MadeAxes axes;
  ExpectMadePlaces(TrackFieldsOf(MadeFrame(axes), *TrackOf(axes)));
}

TEST(TrackFields, AreTheSameInAllAxesOfTheOutput) {
  for (const OutputFrame frame :
       {OutputFrame::kSensor, OutputFrame::kVehicle, OutputFrame::kWorld}) {
    for (const Handedness handedness : {Handedness::kRight, Handedness::kLeft}) {
      MadeAxes axes;
      axes.output = {.frame = frame, .handedness = handedness};
      if (frame == OutputFrame::kWorld) axes.output.origin_m = {480.0, 2.0, -1.0};
      // The origin is subtracted before y is negated.
      ExpectMadePlaces(TrackFieldsOf(MadeFrame(axes), *TrackOf(axes)));
    }
  }
}

FieldSelection Selected(const std::string& list, const MadeAxes& axes = {}) {
  FieldSelection fields(list, false, true);
  fields.SetTrack(TrackOf(axes));
  return fields;
}

TEST(TrackFields, AreReadFromPcdFilesByPcl) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "frame.pcd";
  for (const PcdEncoding encoding :
       {PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed, PcdEncoding::kAscii}) {
    std::string bytes;
    EncodePcd(MadeFrame({}), Selected("x,y,z,in_gauge,chainage_m"), encoding, bytes);
    WriteFileWhole(file, bytes);
    pcl::PCLPointCloud2 cloud;
    ASSERT_EQ(pcl::io::loadPCDFile(file.string(), cloud), 0);
    EXPECT_EQ(pcl::getFieldsList(cloud), "x y z chainage_m in_gauge");
    EXPECT_EQ(cloud.fields[3].datatype, pcl::PCLPointField::FLOAT32);
    EXPECT_EQ(cloud.fields[4].datatype, pcl::PCLPointField::UINT8);
    float chainage_m = 0.0F;
    std::memcpy(&chainage_m, &cloud.data[cloud.point_step + cloud.fields[3].offset], 4);
    EXPECT_NEAR(chainage_m, 512.0F, kFloat_m);
    EXPECT_EQ(cloud.data[cloud.point_step + cloud.fields[4].offset], 1);
  }
}

TEST(TrackFields, ComeThroughFilesAsFurtherFieldsOfRecordings) {
  const TemporaryDirectory directory;
  std::string pcd;
  std::string ply;
  EncodePcd(MadeFrame({}), Selected("x,y,z,track_lateral_m,in_gauge"), PcdEncoding::kBinary, pcd);
  EncodePly(MadeFrame({}), Selected("x,y,z,track_lateral_m,in_gauge"), PlyFlavour::kCloudCompare,
            ply);
  WriteFileWhole(directory.path() / "a.pcd", pcd);
  WriteFileWhole(directory.path() / "a.ply", ply);
  for (const char* const name : {"a.pcd", "a.ply"}) {
    const auto frames = ReadAll(directory.path() / name);
    ASSERT_EQ(frames.size(), 1U);
    const auto& foreign = frames[0].foreign;
    ASSERT_EQ(foreign.size(), 2U);
    EXPECT_EQ(foreign[0].name, "track_lateral_m");
    EXPECT_EQ(foreign[1].name, "in_gauge");
    ASSERT_GE(foreign[0].values.size(), 3U);
    EXPECT_NEAR(foreign[0].values[2], 3.0F, kFloat_m);
    EXPECT_EQ(foreign[1].values[1], 1.0F);
    EXPECT_EQ(foreign[1].values[2], 0.0F);
  }
}

TEST(TrackFields, AreFieldsOfMessages) {
  const ros::CloudSpec spec{ros::PointLayout::kRailcast, Selected("x,y,z,track_height_m")};
  const ros::PointCloud2 message = ros::MakeCloud(MadeFrame({}), spec, "lidar");
  ASSERT_EQ(message.fields.size(), 4U);
  EXPECT_EQ(message.fields[3].name, "track_height_m");
  float height_m = 0.0F;
  std::memcpy(&height_m, &message.data[2 * message.point_step + message.fields[3].offset], 4);
  EXPECT_NEAR(height_m, 2.0F, kFloat_m);
}

TEST(TrackFields, AreNoneOfAllFieldsAndComeAfterThem) {
  EXPECT_EQ(FieldSelection("all", false, true), FieldSelection());
  EXPECT_EQ(FieldSelection("in_gauge,mixed_share,chainage_m,x", false, true).Text(),
            "x,mixed_share,chainage_m,in_gauge");
  EXPECT_TRUE(FieldSelection("x,in_gauge", false, true).NeedsTrack());
  EXPECT_FALSE(FieldSelection().NeedsTrack());
}

TEST(TrackFields, AreRefusedWhereTheTrackIsNotKnown) {
  EXPECT_EQ(MessageOf([] { FieldSelection("x,in_gauge"); }),
            "--fields: must be a field of the frame itself, since only the files and bags of "
            "sequence and dataset have those of the track (got \"in_gauge\")");
}

}  // namespace
}  // namespace railcast
