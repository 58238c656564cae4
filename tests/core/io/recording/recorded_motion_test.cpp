#include "core/io/recording/recorded_motion.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

constexpr std::uint32_t kDuration_ns = 100'000'000;
constexpr std::uint32_t kTime_ns = 40'000'000;
constexpr double kTime_s = 0.04;
constexpr std::uint32_t kWagon = 7;
// Positions within 100 m as float32.
constexpr double kRounding_m = 1e-5;

const Vector3 kVelocity_mps(-30.0, 4.0, 0.5);  // Of the wagon in the world.
const Vector3 kOnWagonAtStamp(60.0, 5.0, 1.0);
const Transform kWorldFromStamp =
    MakeTransform(RotationFromYawPitchRoll(2.0, 0.01, 0.05), Vector3(5.3e6, 6e5, 400));

// The sensor moves straight ahead at 30 m/s, so that ScanMotion is exact.
Transform StampFromSensor(double time_s) {
  return MakeTransform(Eigen::Matrix3d::Identity(), Vector3(30.0 * time_s, 0, 0));
}

Vector3 AtFiring(const Vector3& at_stamp_m) {
  return StampFromSensor(kTime_s).inverse() * at_stamp_m;
}

Vector3 WagonsWay_m() {
  return kTime_s * (kWorldFromStamp.linear().transpose() * kVelocity_mps);
}

// Slot 0 is a point on the wagon, slot 1 on the ground, slot 2 a mirror image of the wagon. All
// three have the same place at their firing, at kTime_ns.
RecordedFrame ThreePoints() {
  RecordedFrame recorded;
  Frame& frame = recorded.frame;
  frame.rows = 1;
  frame.columns = 3;
  frame.returns = 1;
  frame.duration_ns = kDuration_ns;
  frame.world_from_sensor = kWorldFromStamp;
  frame.world_from_sensor_end = kWorldFromStamp * StampFromSensor(0.1);
  const Eigen::Vector3f measured_m = AtFiring(kOnWagonAtStamp + WagonsWay_m()).cast<float>();
  frame.x.assign(3, measured_m.x());
  frame.y.assign(3, measured_m.y());
  frame.z.assign(3, measured_m.z());
  frame.time_ns.assign(3, kTime_ns);
  frame.instance = {kWagon, 0, kWagon};
  frame.outcome = {Outcome::kReturned, Outcome::kReturned, Outcome::kClutter};
  recorded.fields = {"x", "y", "z", "time_ns", "instance", "outcome"};
  recorded.has_pose = true;
  recorded.objects = {
      {.name = "wagon",
       .type = "open_wagon",
       .label = "wagon",
       .instance = kWagon,
       .sensor_from_box = MakeTransform(RotationFromYawPitchRoll(0.7, 0.1, 0), Vector3(65, 5, 2)),
       .velocity_world_mps = kVelocity_mps,
       .points = 1,
       .points_time_ns = kTime_ns}};
  return recorded;
}

double DistanceOf(const Eigen::Vector3f& point_m, const Vector3& expected_m) {
  return (point_m.cast<double>() - expected_m).norm();
}

TEST(RecordedMotion, PutsPointsOfMovingObjectsWhereTheyWereAtTheStamp) {
  const RecordedFrame recorded = ThreePoints();
  const RecordedMotion motion(recorded, Compensation::kAll);
  EXPECT_LT(DistanceOf(motion.PointOf(0), kOnWagonAtStamp), kRounding_m);
  // What stands, and the image of the wagon, which is not where that is, keep their places.
  EXPECT_LT(DistanceOf(motion.PointOf(1), kOnWagonAtStamp + WagonsWay_m()), kRounding_m);
  EXPECT_EQ(motion.PointOf(2), motion.PointOf(1));
  EXPECT_EQ(motion.BoxOf(recorded.objects[0]).matrix(),
            recorded.objects[0].sensor_from_box.matrix());
}

TEST(RecordedMotion, OfTheSensorAloneMovesBoxesToTheMeanTimeOfTheirPoints) {
  const RecordedFrame recorded = ThreePoints();
  const RecordedMotion motion(recorded, Compensation::kSensor);
  EXPECT_EQ(motion.PointOf(0), motion.PointOf(1));
  EXPECT_LT(DistanceOf(motion.PointOf(0), kOnWagonAtStamp + WagonsWay_m()), kRounding_m);
  const Transform box = motion.BoxOf(recorded.objects[0]);
  EXPECT_TRUE(box.translation().isApprox(Vector3(65, 5, 2) + WagonsWay_m(), 1e-12));
  EXPECT_EQ(box.linear(), recorded.objects[0].sensor_from_box.linear());
}

TEST(RecordedMotion, LeavesMeasuredPointsAndPutsBoxesIntoTheAxesOfThatTime) {
  RecordedFrame recorded = ThreePoints();
  // The sensor turns, too, by 0.1 rad in the whole scan.
  recorded.frame.world_from_sensor_end.rotate(RotationFromYawPitchRoll(0.1, 0, 0));
  const RecordedMotion motion(recorded, Compensation::kNone);
  EXPECT_EQ(motion.PointOf(0).x(), recorded.frame.x[0]);
  const Transform stamp_from_firing =
      StampFromSensor(kTime_s) *
      MakeTransform(RotationFromYawPitchRoll(0.1 * kTime_s / 0.1, 0, 0), Vector3::Zero());
  Transform at_stamp = recorded.objects[0].sensor_from_box;
  at_stamp.translation() += WagonsWay_m();
  // Rounding of world coordinates, 1e-9 m, and of unit vectors at their ends.
  EXPECT_TRUE(motion.BoxOf(recorded.objects[0])
                  .isApprox(Transform(stamp_from_firing.inverse() * at_stamp), 1e-8));
}

TEST(RecordedMotion, LeavesKittisPointsAndPutsBoxesWhereTheyWereSeen) {
  RecordedFrame recorded = ThreePoints();
  recorded.axes = PointAxes::kSensorAtStamp;
  for (const Compensation wanted :
       {Compensation::kAll, Compensation::kSensor, Compensation::kNone}) {
    const RecordedMotion motion(recorded, wanted);
    EXPECT_EQ(motion.PointOf(0).x(), recorded.frame.x[0]);
    EXPECT_TRUE(motion.BoxOf(recorded.objects[0])
                    .translation()
                    .isApprox(Vector3(65, 5, 2) + WagonsWay_m(), 1e-12));
  }
}

TEST(RecordedMotion, LeavesBoxesAtTheStampWhereTheMeanTimeIsNotKnown) {
  RecordedFrame recorded = ThreePoints();
  recorded.objects[0].points_time_ns.reset();
  EXPECT_EQ(RecordedMotion(recorded, Compensation::kSensor).BoxOf(recorded.objects[0]).matrix(),
            recorded.objects[0].sensor_from_box.matrix());
}

}  // namespace
}  // namespace railcast
