#include "core/extras/ros/messages/motion_topics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/frame_topics.h"
#include "core/extras/ros/messages/scene_topics.h"
#include "tests/core/io/example_frame.h"

namespace railcast::ros {
namespace {

TEST(ImuMessage, HasTheVariancesOfItsNoiseAndNoOrientation) {
  ImuSpec spec{.name = "IMU 1", .rate_hz = 100.0};
  spec.gyroscope_noise_density_degps_per_sqrthz = 180.0 / 3.14159265358979;
  spec.accelerometer_noise_density_mps2_per_sqrthz = 0.2;
  ImuSample sample{.time_ns = 1'500'000'000};
  sample.angular_velocity_radps = Vector3(0.1, 0.2, 0.3);
  sample.specific_force_mps2 = Vector3(0.0, 0.0, 9.8);
  const Imu message = ImuMessage(sample, spec);
  EXPECT_EQ(message.header, (Header{{1, 500'000'000}, "IMU_1"}));
  EXPECT_EQ(message.orientation_covariance[0], -1.0);
  EXPECT_EQ(message.angular_velocity, (RosVector3{0.1, 0.2, 0.3}));
  EXPECT_EQ(message.linear_acceleration, (RosVector3{0.0, 0.0, 9.8}));
  // Variance = density^2 x rate; a density of 1 rad/s.
  EXPECT_NEAR(message.angular_velocity_covariance[4], 100.0, 1e-9);
  EXPECT_NEAR(message.linear_acceleration_covariance[8], 0.04 * 100.0, 1e-12);
  EXPECT_EQ(message.linear_acceleration_covariance[1], 0.0);
}

TEST(FixMessage, HasThePlaceAndItsVariances) {
  GnssSample sample{.time_ns = 0, .has_fix = true};
  sample.latitude_deg = 47.4;
  sample.longitude_deg = 9.4;
  sample.position_m = Vector3(1.0, 2.0, 412.0);
  sample.position_sigma_m = Vector3(1.5, 1.5, 3.0);
  const NavSatFix fix = FixMessage(sample, {});
  EXPECT_EQ(fix.header.frame_id, "gnss");
  EXPECT_EQ(fix.status, (NavSatStatus{NavSatStatus::kFix, NavSatStatus::kGps}));
  EXPECT_EQ(fix.latitude, 47.4);
  EXPECT_EQ(fix.altitude, 412.0);
  EXPECT_EQ(fix.position_covariance[8], 9.0);
  EXPECT_EQ(fix.position_covariance_type, NavSatFix::kCovarianceDiagonalKnown);
}

TEST(FixMessage, SaysWhereThereIsNone) {
  const NavSatFix fix = FixMessage({}, {});
  EXPECT_EQ(fix.status.status, NavSatStatus::kNoFix);
  EXPECT_TRUE(std::isnan(fix.latitude));
  EXPECT_EQ(fix.position_covariance_type, NavSatFix::kCovarianceUnknown);
}

TEST(FrameTopics, HaveATopicForEachMotionSensorAndAMessageForEachSample) {
  TopicsSpec spec;
  spec.sensors = {{"front"}};
  spec.motion = {.imus = {{}}, .gnss = {{}}, .odometers = {{}}};
  spec.vehicle_from_imu = {Transform::Identity()};
  const FrameTopics topics(spec);
  const MotionSamples samples = {.imus = {{{}, {}}}, .gnss = {{{}}}, .odometers = {{{}, {}, {}}}};
  const Frame frame = ExampleFrame(0);
  std::vector<std::string> names;
  for (const TopicMessage& message :
       topics.Of({.sensor = 0, .frame = frame, .vehicle = {}, .motion = &samples})) {
    names.push_back(topics.topics()[message.topic].name);
  }
  EXPECT_EQ(std::count(names.begin(), names.end(), "/imu"), 2);
  EXPECT_EQ(std::count(names.begin(), names.end(), "/gnss"), 1);
  EXPECT_EQ(std::count(names.begin(), names.end(), "/odometer"), 3);
  const auto tf = FromCdr<TfMessage>(topics.First(0).front().cdr);
  ASSERT_EQ(tf.transforms.size(), 3U);
  EXPECT_EQ(tf.transforms[2].transform.translation, (RosVector3{0.0, 0.0, 4.0}));
}

SceneBox Wagon() {
  SceneBox box{"wagon_1", "wagon", 3, Vector3(10.0, 3.0, 4.0)};
  box.world_from_box.translation() = Vector3(100.0, 20.0, 2.0);
  box.points = 12;
  box.occlusion = 0.25;
  return box;
}

TEST(BoxesUpdate, ShowsEachObjectAsABoxAndItsLabelInItsColour) {
  const Transform map_from_world =
      MakeTransform(Eigen::Matrix3d::Identity(), Vector3(-90.0, 0.0, 0.0));
  const std::vector<SceneBox> boxes = {Wagon()};
  const SceneUpdate update =
      BoxesUpdate(boxes, ExampleLabels(), map_from_world, 2'000'000'000, 150'000'000);
  ASSERT_EQ(update.entities.size(), 1U);
  const SceneEntity& entity = update.entities[0];
  EXPECT_EQ(entity.id, "wagon_1");
  EXPECT_EQ(entity.frame_id, "map");
  EXPECT_EQ(entity.timestamp, (Time{2, 0}));
  EXPECT_EQ(entity.lifetime, (Duration{0, 150'000'000}));
  ASSERT_EQ(entity.cubes.size(), 1U);
  EXPECT_EQ(entity.cubes[0].pose.position, (Point{10.0, 20.0, 2.0}));
  EXPECT_EQ(entity.cubes[0].size, (RosVector3{10.0, 3.0, 4.0}));
  EXPECT_DOUBLE_EQ(entity.cubes[0].color.r, 213.0 / 255.0);
  ASSERT_EQ(entity.texts.size(), 1U);
  EXPECT_EQ(entity.texts[0].text, "wagon wagon_1");
  // Above the box, whose middle is at 2 m.
  EXPECT_GT(entity.texts[0].pose.position.z, 4.0);
  EXPECT_EQ(entity.metadata.back(), (KeyValuePair{"occlusion", "0.25"}));
}

TEST(BoxesUpdate, LeavesOutTheOcclusionOfWhatNoRayMeets) {
  SceneBox box = Wagon();
  box.occlusion.reset();
  const SceneUpdate update = BoxesUpdate({&box, 1}, ExampleLabels(), Transform::Identity(), 0, 1);
  for (const KeyValuePair& pair : update.entities.at(0).metadata) EXPECT_NE(pair.key, "occlusion");
}

TEST(RailsUpdate, DrawsALineAlongEachRail) {
  const SceneUpdate update =
      RailsUpdate({{{0.0, 0.75, 0.0}, {5.0, 0.75, 0.0}}, {{0.0, -0.75, 0.0}, {5.0, -0.75, 0.0}}},
                  Transform::Identity(), 0);
  ASSERT_EQ(update.entities.size(), 1U);
  ASSERT_EQ(update.entities[0].lines.size(), 2U);
  EXPECT_EQ(update.entities[0].lines[1].points[1], (Point{5.0, -0.75, 0.0}));
  EXPECT_EQ(update.entities[0].lifetime, Duration{});
}

}  // namespace
}  // namespace railcast::ros
