#include "analysis/extras/detectors/run_evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "analysis/extras/detectors/alarm_report.h"
#include "analysis/extras/detectors/detection.h"
#include "tests/analysis/extras/detectors/made_frames.h"
#include "tests/core/rail/world/made_track.h"

namespace railcast {
namespace {

constexpr double kFrameWay_m = 2.0;
const Vector3 kCube_m(0.3, 0.3, 0.3);

/// Box of a cube whose foot is on the rails.
DetectedBox CubeAt(double x_m, double y_m, const std::string& class_name = "") {
  return {.box = {MakeTransform(Eigen::Matrix3d::Identity(), {x_m, y_m, 0.15}), kCube_m},
          .label = 0,
          .class_name = class_name};
}

/// Drives at 20 m/s from chainage 500 on, 2 m a frame, past objects that stand.
class Drive {
 public:
  void Place(const std::string& name, double x_m, double y_m) {
    placed_.push_back({name, x_m, y_m});
  }

  void Frames(int num, const std::vector<DetectedBox>& boxes, double latency_s = 0.0) {
    for (int i = 0; i < num; ++i) {
      const double sensor_x_m = 500.0 + kFrameWay_m * index_;
      RecordedFrame recorded = FrameOf({}, index_, sensor_x_m);
      for (const auto& [name, x_m, y_m] : placed_) {
        AddObject(name, x_m - sensor_x_m, y_m, kCube_m, recorded);
      }
      evaluator_.Add(recorded, {boxes, latency_s});
      ++index_;
    }
  }

  [[nodiscard]] EvaluatedRun Finish(const DetectSpec& spec = {}) {
    return evaluator_.Finish("run", 1, spec);
  }

 private:
  struct Placed {
    std::string name;
    double x_m;
    double y_m;
  };
  std::vector<Placed> placed_;
  LabelTable labels_;
  RunEvaluator evaluator_{StraightTrack(), labels_, Transform::Identity()};
  std::uint32_t index_ = 0;
};

TEST(RunEvaluation, DetectsAnObjectWhoseBoxIsReportedInEnoughFrames) {
  Drive drive;
  drive.Place("cube", 600.0, 0.0);
  drive.Frames(10, {});
  drive.Frames(10, {CubeAt(600.0, 0.0)});
  const EvaluatedRun run = drive.Finish();
  const ObjectDetection& detection = run.run.detections.at("cube");
  EXPECT_EQ(detection.fate, Fate::kDetected);
  // Frames 10, 11 and 12; the face is 0.15 m before the middle.
  EXPECT_EQ(detection.frame, 12U);
  EXPECT_NEAR(detection.distance_m, std::hypot(100.0 - 12 * kFrameWay_m - 0.15, 2.0 - 0.3), 1e-6);
  EXPECT_TRUE(run.alarms.empty());
  EXPECT_NEAR(run.driven_m, 19 * kFrameWay_m, 1e-9);
}

TEST(RunEvaluation, MatchesBoxesThatAreAsWrongAsPointsAre) {
  const auto is_detected = [](const DetectedBox& box) {
    Drive drive;
    drive.Place("cube", 600.0, 0.0);
    drive.Frames(5, {box});
    return drive.Finish().run.detections.at("cube").fate == Fate::kDetected;
  };
  // The true box reaches from -0.45 m to 0.45 m with its slack: half of a cube may be outside.
  EXPECT_TRUE(is_detected(CubeAt(600.0, 0.44)));
  EXPECT_FALSE(is_detected(CubeAt(600.0, 0.46)));
}

TEST(RunEvaluation, CountsTheDistanceThatIsLeftAfterTheLatency) {
  const auto distance_m = [](double latency_s) {
    Drive drive;
    drive.Place("cube", 600.0, 0.0);
    drive.Frames(5, {CubeAt(600.0, 0.0)}, latency_s);
    return drive.Finish().run.detections.at("cube").distance_m;
  };
  EXPECT_NEAR(distance_m(0.0) - distance_m(0.5), 0.5 * 20.0, 1e-9);
  EXPECT_EQ(distance_m(10.0), 0.0);
}

TEST(RunEvaluation, AddsTheWayOfWhatComesNearerToTheLatency) {
  const ObjectCourse course = {
      .type = "box",
      .label = "object",
      .sightings = {{.frame = 3, .distance_m = 90.0, .speed_mps = 20.0, .approach_mps = 5.0}}};
  ObjectDetection detection{.fate = Fate::kDetected, .distance_m = 90.0, .frame = 3};
  detection.speed_mps = 20.0;
  AddLatency(course, 2.0, detection);
  EXPECT_EQ(detection.distance_m, 40.0);
}

TEST(FalseAlarms, CountsRunsOfFramesOnce) {
  Drive drive;
  const std::vector<DetectedBox> ghost = {CubeAt(620.0, 1.0, "ghost")};
  drive.Frames(2, ghost);  // Too few.
  drive.Frames(5, {});
  drive.Frames(7, ghost);
  drive.Frames(1, {});  // The rule holds on.
  drive.Frames(4, ghost);
  drive.Frames(5, {});
  drive.Frames(3, ghost);
  const EvaluatedRun run = drive.Finish();
  ASSERT_EQ(run.alarms.size(), 2U);
  EXPECT_EQ(run.alarms[0].frame, 9U);
  EXPECT_EQ(run.alarms[1].frame, 26U);
  EXPECT_NEAR(run.alarms[0].s_m, 620.0, 1e-6);
  EXPECT_EQ(run.alarms[0].cause, "ghost");
  EXPECT_EQ(run.alarms[0].object, "");
}

TEST(FalseAlarms, AreOfBoxesInTheGaugeOnly) {
  Drive drive;
  drive.Frames(5, {CubeAt(620.0, 1.8), CubeAt(480.0, 0.0)});
  EXPECT_TRUE(drive.Finish().alarms.empty());
}

TEST(FalseAlarms, AreAtAnObjectThatDoesNotReachIntoTheGauge) {
  Drive drive;
  drive.Place("outside", 600.0, 1.8);
  drive.Place("inside", 640.0, 0.0);
  // Half of it is in the gauge, although the object is not.
  drive.Frames(5, {CubeAt(600.0, 1.6), CubeAt(640.0, 0.0)});
  const EvaluatedRun run = drive.Finish();
  ASSERT_EQ(run.alarms.size(), 1U);
  EXPECT_EQ(run.alarms[0].object, "outside");
  EXPECT_EQ(run.ObjectsBeside(), std::vector<std::string>{"outside"});
  EXPECT_EQ(run.run.detections.at("inside").fate, Fate::kDetected);
}

TEST(FalseAlarms, AreNoneWhereABoxIsAlsoOfAnObjectInTheWay) {
  Drive drive;
  drive.Place("outside", 600.0, 1.8);
  drive.Place("inside", 600.0, 1.3);
  DetectedBox both = CubeAt(600.0, 1.55);
  both.box.size_m.y() = 0.8;
  drive.Frames(5, {both});
  const EvaluatedRun run = drive.Finish();
  EXPECT_TRUE(run.alarms.empty());
  EXPECT_EQ(run.run.detections.at("inside").fate, Fate::kDetected);
}

TEST(FalseAlarms, OfNoneHaveAnIntervalThatIsExact) {
  // No alarm in 3 km: the rate is below -ln(0.025) / 3 with 97.5 %.
  const Estimate none = AlarmsPerKm(0, 3'000.0);
  EXPECT_EQ(none.value, 0.0);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, -std::log(0.025) / 3.0, 1e-12);
  EXPECT_NEAR(AlarmsPerKm(5, 2'000.0).value, 2.5, 1e-12);
  EXPECT_FALSE(AlarmsPerKm(0, 0.0).is_enough());
}

OrientedBox BoxOfSize(const Vector3& size_m, const Vector3& center_m = Vector3::Zero()) {
  return {MakeTransform(Eigen::Matrix3d::Identity(), center_m), size_m};
}

TEST(BoxOverlap, IsTheShareOfTheSmallerBox) {
  const OrientedBox wagon = BoxOfSize({20.0, 3.0, 4.0});
  EXPECT_EQ(OverlapOf(wagon, wagon), 1.0);
  // The face that a sensor sees of a wagon is all in it, whatever share of the wagon that is.
  const OrientedBox face = BoxOfSize({0.2, 3.0, 4.0}, {-9.9, 0.0, 0.0});
  EXPECT_EQ(OverlapOf(face, wagon), 1.0);
  EXPECT_EQ(OverlapOf(wagon, face), 1.0);
}

TEST(BoxOverlap, FallsAsBoxesPart) {
  const Vector3 size_m(2.0, 1.0, 4.0);
  const OrientedBox box = BoxOfSize(size_m);
  EXPECT_EQ(OverlapOf(box, BoxOfSize(size_m, {1.0, 0.0, 0.0})), 0.5);
  EXPECT_EQ(OverlapOf(box, BoxOfSize(size_m, {0.5, 0.0, 0.0})), 0.75);
  EXPECT_EQ(OverlapOf(box, BoxOfSize(size_m, {1.0, 0.5, 0.0})), 0.25);
  EXPECT_EQ(OverlapOf(box, BoxOfSize(size_m, {0.0, 0.0, 4.0})), 0.0) << "touching";
  EXPECT_EQ(OverlapOf(box, BoxOfSize(size_m, {50.0, 0.0, 0.0})), 0.0);
}

// Two unit squares turned by 45 degrees share an octagon of 2 (sqrt(2) - 1).
TEST(BoxOverlap, KnowsTurnedBoxes) {
  const OrientedBox box = BoxOfSize({1.0, 1.0, 1.0});
  OrientedBox turned = box;
  turned.world_from_box.rotate(Eigen::AngleAxisd(std::numbers::pi / 4.0, Vector3::UnitZ()));
  // Four faces cut it, each exact to 1/32 of where it cuts.
  EXPECT_NEAR(OverlapOf(box, turned), 2.0 * (std::sqrt(2.0) - 1.0), 0.02);
  OrientedBox upright = box;
  upright.world_from_box.rotate(Eigen::AngleAxisd(std::numbers::pi / 2.0, Vector3::UnitX()));
  EXPECT_EQ(OverlapOf(box, upright), 1.0);
}

TEST(BoxOverlap, DoesNotDependOnWhereBothAre) {
  const Transform far =
      MakeTransform(RotationFromYawPitchRoll(0.7, 0.1, -0.2), Vector3(-2e3, 1e3, 600.0));
  const OrientedBox box = BoxOfSize({2.0, 1.0, 4.0});
  const OrientedBox other = BoxOfSize({2.0, 1.0, 4.0}, {0.45, 0.0, 0.0});
  EXPECT_EQ(
      OverlapOf({far * box.world_from_box, box.size_m}, {far * other.world_from_box, other.size_m}),
      OverlapOf(box, other));
}

TEST(BoxOverlap, OfAGrownBoxIncludesWhatIsBesideIt) {
  const OrientedBox cube = BoxOfSize({0.3, 0.3, 0.3});
  const OrientedBox beside = BoxOfSize({0.1, 0.1, 0.1}, {0.0, 0.3, 0.0});
  EXPECT_EQ(OverlapOf(cube, beside), 0.0);
  EXPECT_EQ(OverlapOf(Grown(cube, 0.3), beside), 1.0);
  EXPECT_TRUE(IsInside(Grown(cube, 0.3), Vector3(0.0, 0.44, -0.44)));
  EXPECT_FALSE(IsInside(Grown(cube, 0.3), Vector3(0.0, 0.46, 0.0)));
}

}  // namespace
}  // namespace railcast
