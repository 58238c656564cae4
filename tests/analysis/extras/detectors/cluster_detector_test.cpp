#include "analysis/extras/detectors/cluster_detector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/extras/detectors/made_frames.h"
#include "tests/core/rail/world/made_track.h"

namespace railcast {
namespace {

constexpr double kReach_m = 300.0;

std::vector<DetectedBox> ClustersIn(const RecordedFrame& recorded,
                                    const ClusterDetectorSpec& spec = {}) {
  return FindClusters(recorded, Transform::Identity(), StraightTrack(), spec, kReach_m);
}

/// 4 x 4 points on a square that faces the sensor, with its middle there.
void AddSquare(const Vector3& middle_m, double side_m, std::vector<Vector3>& points) {
  for (int i = 0; i < 16; ++i) {
    points.emplace_back(middle_m +
                        Vector3(0.0, side_m * (i % 4 / 3.0 - 0.5), side_m * (i / 4 / 3.0 - 0.5)));
  }
}

TEST(ClusterDetector, PutsABoxAroundEachCluster) {
  std::vector<Vector3> points;
  AddSquare({100.0, 1.0, -1.0}, 0.6, points);
  AddSquare({80.0, -1.0, -0.5}, 0.3, points);
  const auto boxes = ClustersIn(FrameOf(points));
  ASSERT_EQ(boxes.size(), 2U);
  // The nearest first.
  EXPECT_TRUE(boxes[0].box.world_from_box.translation().isApprox(Vector3(580.0, -1.0, 1.5), 1e-6));
  EXPECT_TRUE(boxes[0].box.size_m.isApprox(Vector3(0.1, 0.3, 0.3), 1e-4));
  EXPECT_TRUE(boxes[1].box.world_from_box.translation().isApprox(Vector3(600.0, 1.0, 1.0), 1e-6));
  EXPECT_TRUE(boxes[1].box.size_m.isApprox(Vector3(0.1, 0.6, 0.6), 1e-4));
}

TEST(ClusterDetector, ChainsPointsByTheirDistanceInPlan) {
  std::vector<Vector3> points;
  AddSquare({100.0, 0.0, -1.0}, 0.3, points);
  AddSquare({100.69, 0.0, 1.5}, 0.3, points);
  EXPECT_EQ(ClustersIn(FrameOf(points)).size(), 1U);
  EXPECT_EQ(ClustersIn(FrameOf(points), {.cluster_distance_m = 0.6}).size(), 2U);
}

TEST(ClusterDetector, AsksForANumberOfPoints) {
  std::vector<Vector3> points;
  AddSquare({100.0, 0.0, -1.0}, 0.3, points);
  EXPECT_EQ(ClustersIn(FrameOf(points), {.min_points = 16}).size(), 1U);
  EXPECT_EQ(ClustersIn(FrameOf(points), {.min_points = 17}).size(), 0U);
}

TEST(ClusterDetector, SeesWhatIsInTheGaugeAheadAboveTheTrack) {
  const auto is_seen = [](const Vector3& middle_m) {
    std::vector<Vector3> points;
    AddSquare(middle_m, 0.02, points);
    return !ClustersIn(FrameOf(points)).empty();
  };
  // The sensor is 2 m above top of rail.
  EXPECT_TRUE(is_seen({100.0, 0.0, -2.0 + 0.12}));
  EXPECT_FALSE(is_seen({100.0, 0.0, -2.0 + 0.08})) << "the track itself";
  EXPECT_TRUE(is_seen({100.0, 1.56, -1.0}));
  EXPECT_FALSE(is_seen({100.0, -1.59, -1.0})) << "beside the gauge";
  EXPECT_FALSE(is_seen({100.0, 0.0, 2.0 + 3.3})) << "above the pantograph";
  EXPECT_FALSE(is_seen({-10.0, 0.0, -1.0})) << "behind";
  EXPECT_TRUE(is_seen({5.1, 0.0, -1.0}));
  EXPECT_FALSE(is_seen({4.9, 0.0, -1.0})) << "before the sensor";
  EXPECT_FALSE(is_seen({320.0, 0.0, -1.0})) << "out of reach";
}

TEST(ClusterDetector, TellsTheLabelOfMostPoints) {
  std::vector<Vector3> points;
  AddSquare({100.0, 0.0, -1.0}, 0.3, points);
  RecordedFrame recorded = FrameOf(points);
  for (std::size_t i = 0; i < 9; ++i) recorded.frame.label[i] = 7;
  for (std::size_t i = 9; i < 16; ++i) recorded.frame.label[i] = 3;
  EXPECT_EQ(ClustersIn(recorded).at(0).label, 7U);
}

// At 20 m/s a sensor has come 1 m nearer by the middle of its scan.
TEST(ClusterDetector, UndoesTheSensorsMotion) {
  std::vector<Vector3> points;
  AddSquare({99.0, 0.0, -1.0}, 0.3, points);
  RecordedFrame recorded = FrameOf(points);
  for (std::uint32_t& time_ns : recorded.frame.time_ns) time_ns = 50'000'000;
  EXPECT_NEAR(ClustersIn(recorded).at(0).box.world_from_box.translation().x(), 600.0, 1e-4);
}

TEST(ClusterDetector, FollowsTheCurve) {
  constexpr double kRadius_m = 300.0;
  const ScenarioSpec scenario = ScenarioOn(ElementType::kArc, 800.0, kRadius_m);
  const OwnTrack track(*MakeWorld(scenario), scenario.world.catenary);
  const auto at = [&](double s_m, double d_m) -> Vector3 {
    const double angle_rad = s_m / kRadius_m;
    const double radius_m = kRadius_m - d_m;
    return {radius_m * std::sin(angle_rad), kRadius_m - radius_m * std::cos(angle_rad), 1.0};
  };
  const GaugeAhead gauge(track, Transform::Identity(), Vector3(2.0, 0.0, 2.0), 300.0);
  const auto place = gauge.PlaceInside(at(203.0, 1.2));
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->chainage_m, 203.0, 1e-3);
  EXPECT_NEAR(place->lateral_m, 1.2, 1e-3);
  EXPECT_NEAR(place->height_m, 1.0, 1e-6);
  EXPECT_FALSE(gauge.PlaceInside(at(203.0, 1.7)));
  EXPECT_FALSE(gauge.PlaceInside(at(203.0, -1.7)));
  EXPECT_FALSE(gauge.PlaceInside(Vector3(200.0, 0.0, 1.0))) << "straight ahead";
}

TEST(ClusterDetector, KeepsToATrainsOwnGauge) {
  const ScenarioSpec scenario = ScenarioOn(ElementType::kStraight, 2'000.0);
  const OwnTrack track(*MakeWorld(scenario), scenario.world.catenary,
                       PartsOf(TrainGauge{2.8, 2.83}));
  const GaugeAhead gauge(track, MakeTransform(Eigen::Matrix3d::Identity(), {500.0, 0.0, 0.0}),
                         Vector3(500.0, 0.0, 2.0), 300.0);
  EXPECT_TRUE(gauge.PlaceInside(Vector3(600.0, 1.39, 1.0)));
  EXPECT_FALSE(gauge.PlaceInside(Vector3(600.0, 1.41, 1.0)));
  EXPECT_TRUE(gauge.PlaceInside(Vector3(600.0, 0.0, 2.82)));
  EXPECT_FALSE(gauge.PlaceInside(Vector3(600.0, 0.0, 2.84)));
}

}  // namespace
}  // namespace railcast
