#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/io/record/record_text.h"
#include "core/io/run/frame_record.h"
#include "tests/core/io/example_frame.h"

namespace railcast {
namespace {

TEST(CountFrame, CountsEveryFiringOnceAndEveryPoint) {
  const Frame frame = ExampleFrame(0, 6, 10);  // Six rounds of ten slots.
  const FrameCounts counts = CountFrame(frame, ExampleLabels());
  for (std::size_t i = 0; i < counts.outcomes.size(); ++i) {
    const auto outcome = static_cast<Outcome>(i);
    const bool takes_turns =
        outcome == Outcome::kSensorDropout || outcome == Outcome::kCoverBlocked;
    EXPECT_EQ(counts.outcomes[i], takes_turns ? 3U : 6U) << i;
  }
  EXPECT_EQ(counts.points, 12U);
  std::uint64_t labelled = 0;
  for (const auto& [label, count] : counts.points_per_label) labelled += count;
  EXPECT_EQ(labelled, 12U);
}

TEST(CountFrame, CountsAFiringWithTwoReturnsOnceAndItsPointsTwice) {
  Frame frame = ExampleFrame(0, 1, 2);
  frame.columns = 1;
  frame.returns = 2;
  frame.outcome = {Outcome::kReturned, Outcome::kReturned};
  frame.label = {1, 12};
  const FrameCounts counts = CountFrame(frame, ExampleLabels());
  EXPECT_EQ(counts.outcomes[0], 1U);
  EXPECT_EQ(counts.points, 2U);
}

// Near half a turn the canonical quaternions at the stamp and at the end have opposite signs.
TEST(ScanPosesOf, HasTheQuaternionNearerToTheOneBefore) {
  constexpr double kHalfTurn_rad = std::numbers::pi;
  Frame frame;
  frame.duration_ns = 99'750'000;
  for (const double turn_rad : {-0.02, 0.02}) {
    frame.world_from_sensor =
        MakeTransform(RotationFromYawPitchRoll(kHalfTurn_rad - turn_rad, 0, 0), Vector3(1, 2, 3));
    frame.world_from_sensor_end =
        MakeTransform(RotationFromYawPitchRoll(kHalfTurn_rad + turn_rad, 0, 0), Vector3(4, 2, 3));
    const std::vector<RecordedScanPose> poses = ScanPosesOf(frame);
    ASSERT_EQ(poses.size(), 1U);
    const RecordedScanPose& end = poses[0];
    EXPECT_EQ(end.time_ns, 99'750'000U);
    EXPECT_EQ(end.position_m, Vector3(4, 2, 3));
    // The rotation between them is 2 turn_rad, so the quaternions are turn_rad apart.
    EXPECT_NEAR(end.rotation.dot(CanonicalRotation(frame.world_from_sensor)), std::cos(turn_rad),
                1e-12);
    // With half a turn in between, the signs differ at the first or at the last step.
    frame.poses_between = {{50'000'000, MakeTransform(RotationFromYawPitchRoll(kHalfTurn_rad, 0, 0),
                                                      Vector3(2, 2, 3))}};
    const std::vector<RecordedScanPose> three = ScanPosesOf(frame);
    ASSERT_EQ(three.size(), 2U);
    EXPECT_EQ(three[0].time_ns, 50'000'000U);
    EXPECT_EQ(three[0].position_m, Vector3(2, 2, 3));
    EXPECT_EQ(three[1], end);
    EXPECT_NEAR(three[0].rotation.dot(end.rotation), std::cos(0.5 * turn_rad), 1e-12);
    frame.poses_between.clear();
  }
}

TEST(FrameRecord, ReadsBack) {
  FrameRecord record;
  record.frame = 7;
  record.stamp_ns = 700'000'000;
  record.scan_poses = {{49'750'000, Vector3(5.3e6, 6e5, 0.2), Eigen::Quaterniond::Identity()},
                       {99'750'000, Vector3(5.3e6 + 1.0 / 3.0, 6e5, 0.1),
                        Eigen::Quaterniond(-0.1, 0.7, -0.5, 1.0 / 7.0).normalized()}};
  record.files = {{"frames/000007.pcd", "0123456789abcdef", 1234}};
  record.records_hash = "fedcba9876543210";
  record.counts = CountFrame(ExampleFrame(7), ExampleLabels());
  const std::string line = HashedRecordLine(record);
  EXPECT_EQ(ParseFrameLine(line), record);
  EXPECT_EQ(line.find('\n'), line.size() - 1);
}

TEST(ParseFrameLine, GivesNothingForAChangedLine) {
  FrameRecord record;
  record.scan_poses.emplace_back();
  record.counts.points = 12;
  std::string line = HashedRecordLine(record);
  ASSERT_EQ(ParseFrameLine(line), record);
  line.replace(line.find("\"points\":12"), 11, "\"points\":13");
  EXPECT_FALSE(ParseFrameLine(line).has_value());
}

TEST(ParseFrameLine, GivesNothingForATornLine) {
  const std::string line = HashedRecordLine(FrameRecord{});
  for (std::size_t size = 0; size + 1 < line.size(); ++size) {
    EXPECT_FALSE(ParseFrameLine(line.substr(0, size)).has_value()) << size;
  }
  EXPECT_FALSE(ParseFrameLine("{\"frame\": -1}\n").has_value());
}

TEST(PoseLine, GivesTheSameDoublesBack) {
  const Transform world_from_sensor = MakeTransform(RotationFromYawPitchRoll(3.0, 0.01, -0.2),
                                                    Vector3(5.3e6 + 1.0 / 3.0, 6e5, 0.1));
  const PoseRecord pose(1'234'567'890'123LL, world_from_sensor);
  const PoseRecord back = ReadPoseRecord(PoseLine(pose), "poses.csv:2");
  EXPECT_EQ(back.stamp_ns, pose.stamp_ns);
  EXPECT_EQ(back.position_m, pose.position_m);
  EXPECT_EQ(back.rotation.coeffs(), pose.rotation.coeffs());
  // Converting a quaternion to a matrix rounds numbers of up to 1 several times.
  EXPECT_TRUE(back.WorldFromSensor().linear().isApprox(world_from_sensor.linear(), 1e-14));
}

TEST(PoseLine, IsStampPositionAndQuaternion) {
  EXPECT_EQ(
      PoseLine(PoseRecord(100, MakeTransform(Eigen::Matrix3d::Identity(), Vector3(1, 2.5, -3)))),
      "100,1,2.5,-3,0,0,0,1\n");
}

TEST(CanonicalRotation, HasAPositiveRealPart) {
  for (const double yaw_rad : {-3.1, -1.0, 0.0, 2.0, 3.1}) {
    const Transform turn = MakeTransform(RotationFromYawPitchRoll(yaw_rad, 0, 0), Vector3::Zero());
    EXPECT_GE(CanonicalRotation(turn).w(), 0.0);
  }
}

}  // namespace

}  // namespace railcast
