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
#include "railcast/io/cloud_files.h"
#include "railcast/io/recording.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/rail/world/made_track.h"
#include "tests/support/clouds.h"
#include "tests/support/pcl_reads.h"
#include "tests/support/written_file.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::FloatNear;
using testing::IsNan;

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
// The points are float32, at most 50 m from the origin of their axes: 4e-6 m; chainages of 500 m
// are stored to 3e-5 m.
constexpr float kFloat_m = 1e-4F;

/// Where the points of MadeTrackFrame() are on the straight track: chainage, lateral and height.
/// The fourth slot has none.
const std::vector<Vector3> kPlaces_m = {{510.0, 0.0, 1.0}, {512.0, -1.5, 0.5}, {514.0, 3.0, 2.0}};

/// The output as the points of MadeTrackFrame() are in.
struct MadeAxes {
  OutputSpec output;
  Transform vehicle_from_sensor =
      MakeTransform(RotationFromYawPitchRoll(0.2, 0.1, 0.0), Vector3(1.0, 0.0, 2.5));
};

/// A scan of 0.1 s by a sensor that moves from 500 to 504 m, with a point every 25 ms.
Frame MadeTrackFrame(const MadeAxes& axes) {
  Frame frame;
  frame.Resize(1, 4, 1);
  frame.duration_ns = 100'000'000;
  const auto world_from_vehicle = [](double share) {
    return MakeTransform(Eigen::Matrix3d::Identity(), Vector3(500.0 + 4.0 * share, 0.0, 0.0));
  };
  frame.world_from_sensor = world_from_vehicle(0.0) * axes.vehicle_from_sensor;
  frame.world_from_sensor_end = world_from_vehicle(1.0) * axes.vehicle_from_sensor;
  for (std::size_t slot = 0; slot < 4; ++slot) {
    frame.x[slot] = frame.y[slot] = frame.z[slot] = kNotANumber;
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
  ExpectMadePlaces(TrackFieldsOf(MadeTrackFrame(axes), *TrackOf(axes)));
}

TEST(TrackFields, AreTheSameInAllAxesOfTheOutput) {
  for (const OutputFrame frame :
       {OutputFrame::kSensor, OutputFrame::kVehicle, OutputFrame::kWorld}) {
    for (const Handedness handedness : {Handedness::kRight, Handedness::kLeft}) {
      MadeAxes axes;
      axes.output = {.frame = frame, .handedness = handedness};
      if (frame == OutputFrame::kWorld) axes.output.origin_m = {480.0, 2.0, -1.0};
      // The origin is subtracted before y is negated.
      ExpectMadePlaces(TrackFieldsOf(MadeTrackFrame(axes), *TrackOf(axes)));
    }
  }
}

FieldSelection Selected(const std::string& list, const MadeAxes& axes = {}) {
  FieldSelection fields(list, false, true);
  fields.SetTrack(TrackOf(axes));
  return fields;
}

TEST(TrackFields, AreReadFromPcdFilesByPcl) {
  for (const PcdEncoding encoding :
       {PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed, PcdEncoding::kAscii}) {
    const WrittenFile file(
        "frame.pcd", PcdBytes(MadeTrackFrame({}), Selected("x,y,z,in_gauge,chainage_m"), encoding));
    const auto cloud = PclReads(file.path());
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
  const FieldSelection fields = Selected("x,y,z,track_lateral_m,in_gauge");
  const WrittenFile pcd("a.pcd", PcdBytes(MadeTrackFrame({}), fields));
  const WrittenFile ply("a.ply", PlyBytes(MadeTrackFrame({}), fields, PlyFlavour::kCloudCompare));
  for (const WrittenFile* const file : {&pcd, &ply}) {
    const auto frames = ReadAll(file->path());
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
  const ros::PointCloud2 message = ros::MakeCloud(MadeTrackFrame({}), spec, "lidar");
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

constexpr const char* kAll =
    "x,y,z,intensity,power_ratio,range_m,time_ns,ring,column,return_index,return_count,label,"
    "instance,outcome,true_range_m,incidence_rad,material,footprint_share,mixed_share";

TEST(FieldSelection, IsEverythingByDefault) {
  EXPECT_EQ(FieldSelection().Text(), kAll);
  EXPECT_EQ(FieldSelection("all"), FieldSelection());
}

TEST(FieldSelection, KeepsTheTablesOrder) {
  EXPECT_EQ(FieldSelection("label,z,x,y").Text(), "x,y,z,label");
}

TEST(FieldSelection, NamesTheNearestFieldForEveryMisspeltOne) {
  EXPECT_EQ(MessageOf([] { FieldSelection("x,lable,range"); }),
            "--fields: unknown field, the nearest is \"label\" (got \"lable\")\n"
            "--fields: unknown field, the nearest is \"range_m\" (got \"range\")");
}

TEST(FieldSelection, NamesAllFieldsForWhatIsNearToNone) {
  const std::string rule =
      "--fields: unknown field, must be \"x\", \"y\", \"z\", \"intensity\", \"power_ratio\", "
      "\"range_m\", \"time_ns\", \"ring\", \"column\", \"return_index\", \"return_count\", "
      "\"label\", \"instance\", \"outcome\", \"true_range_m\", \"incidence_rad\", \"material\", "
      "\"footprint_share\" or \"mixed_share\" (got ";
  EXPECT_EQ(MessageOf([] { FieldSelection("foo"); }), rule + "\"foo\")");
  EXPECT_EQ(MessageOf([] { FieldSelection("x,,y"); }), rule + "\"\")");
}

TEST(FieldSelection, HasVelocitiesOfSensorsThatMeasureThem) {
  EXPECT_EQ(FieldSelection("all", true).Text(),
            std::string(kAll) + ",radial_velocity_mps,true_radial_velocity_mps");
  EXPECT_EQ(FieldSelection("radial_velocity_mps,x", true).Text(), "x,radial_velocity_mps");
  EXPECT_EQ(MessageOf([] { FieldSelection("x,radial_velocity_mps"); }),
            "--fields: must be a field of a sensor without lidar.velocity (got "
            "\"radial_velocity_mps\")");
}

TEST(FieldSelection, RefusesAFieldTwice) {
  EXPECT_EQ(MessageOf([] { FieldSelection("x,y,x"); }), "--fields: field \"x\" comes twice");
}

}  // namespace
}  // namespace railcast
