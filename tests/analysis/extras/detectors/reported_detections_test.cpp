#include "analysis/extras/detectors/reported_detections.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/analysis/extras/detectors/made_frames.h"
#include "tests/core/io/message_of.h"
#include "tests/core/rail/world/made_track.h"

namespace railcast {
namespace {

std::string FaultOf(const std::string& text) {
  return MessageOf([&] { (void)ReadDetectionLines(text, "d.jsonl"); });
}

std::string ReportedLine(const std::string& detection) {
  return R"({"frame": 12, "detections": [)" + detection + "]}\n";
}

TEST(DetectionLines, ReadBoxesAndClusters) {
  const ReportedRun run = ReadDetectionLines(
      R"({"frame": 12, "latency_ms": 80, "detections": [{"center_m": [20, -1, 0.5],)"
      R"( "size_m": [1, 2, 3], "quaternion_xyzw": [0, 0, 1, 0], "score": 0.9, "class": "person"}]})"
      "\n"
      R"({"frame": 14, "compensate": "sensor", "detections": [{"points": [7, 3]}]})"
      "\n",
      "d.jsonl");
  ASSERT_EQ(run.size(), 2U);
  EXPECT_EQ(run[0].frame, 12U);
  EXPECT_EQ(run[0].latency_ms, 80.0);
  EXPECT_EQ(run[0].compensation, Compensation::kNone);
  const ReportedDetection& box = run[0].detections.at(0);
  EXPECT_EQ(box.center_m, (std::array{20.0, -1.0, 0.5}));
  EXPECT_EQ(box.size_m, (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(box.quaternion_xyzw, (std::array{0.0, 0.0, 1.0, 0.0}));
  EXPECT_EQ(box.score, 0.9);
  EXPECT_EQ(box.class_name, "person");
  EXPECT_EQ(run[1].latency_ms, std::nullopt);
  EXPECT_EQ(run[1].compensation, Compensation::kSensor);
  EXPECT_EQ(run[1].detections.at(0).points, (std::vector<std::uint32_t>{7, 3}));
  EXPECT_TRUE(ReadDetectionLines("", "d.jsonl").empty());
}

TEST(DetectionLines, AreReadStrictly) {
  EXPECT_EQ(FaultOf(ReportedLine(R"({"points": [1], "size_m": [1, 1, 1]})")),
            "d.jsonl:1: /detections/0: must have either center_m and size_m, or points");
  EXPECT_EQ(FaultOf(ReportedLine(R"({"center_m": [1, 1, 1]})")),
            "d.jsonl:1: /detections/0: must have either center_m and size_m, or points");
  EXPECT_EQ(FaultOf(ReportedLine(R"({"points": []})")),
            "d.jsonl:1: /detections/0/points: must not be empty (got [])");
  EXPECT_EQ(
      FaultOf(ReportedLine(R"({"points": [1, -2]})")),
      "d.jsonl:1: /detections/0/points/1: must be a whole number from 0 to 4294967295 (got -2)");
  EXPECT_EQ(FaultOf(ReportedLine(R"({"center_m": [1, 1], "size_m": [1, 1, 1]})")),
            "d.jsonl:1: /detections/0/center_m: must be a list of 3 values (got [1,1])");
  EXPECT_EQ(FaultOf(ReportedLine(R"({"center_m": [1, 1, 1], "size_m": [1, 0, 1]})")),
            "d.jsonl:1: /detections/0/size_m/1: must be > 0 and <= 1000 (got 0)");
  EXPECT_EQ(
      FaultOf(ReportedLine(
          R"({"center_m": [1, 1, 1], "size_m": [1, 1, 1], "quaternion_xyzw": [0, 0, 1, 1]})")),
      "d.jsonl:1: /detections/0/quaternion_xyzw: must have length 1 (got [0,0,1,1])");
  EXPECT_EQ(FaultOf(ReportedLine(R"({"points": [1], "scores": 1})")),
            "d.jsonl:1: /detections/0/scores: unknown key, the nearest is \"score\"");
  EXPECT_EQ(FaultOf("{\"frame\": 1}\n"), "d.jsonl:1: /detections: missing");
}

TEST(DetectionLines, NameFramesThatRise) {
  const auto lines = [](const std::string& first, const std::string& second) {
    return "{\"frame\": " + first + ", \"detections\": []}\n{\"frame\": " + second +
           ", \"detections\": []}\n";
  };
  EXPECT_EQ(FaultOf(lines("4", "4")),
            "d.jsonl:2: /frame: must be > that of the line before, 4 (got 4)");
  EXPECT_EQ(FaultOf(lines("4", "3")),
            "d.jsonl:2: /frame: must be > that of the line before, 4 (got 3)");
  ReportedFrames frames(ReadDetectionLines(lines("4", "6"), "d.jsonl"));
  EXPECT_EQ(frames.Of(2), nullptr);
  EXPECT_EQ(frames.Of(4)->place, "d.jsonl:1");
  EXPECT_EQ(MessageOf([&] { frames.CheckEnd(); }),
            "d.jsonl:2: /frame: must be a frame of the run (got 6)");
  EXPECT_EQ(MessageOf([&] { (void)frames.Of(8); }),
            "d.jsonl:2: /frame: must be a frame of the run (got 6)");
  EXPECT_NE(frames.Of(6), nullptr);
  frames.CheckEnd();
}

/// 8 points about a place ahead of the sensor, each measured at that time.
RecordedFrame FrameWithPoints(const Vector3& middle_m, std::uint32_t time_ns) {
  std::vector<Vector3> points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back(middle_m + 0.2 * Vector3(i % 2 - 0.5, i / 2 % 2 - 0.5, i / 4 - 0.5));
  }
  RecordedFrame recorded = FrameOf(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    recorded.frame.time_ns[i] = time_ns;
    recorded.frame.label[i] = 5;
  }
  return recorded;
}

DetectedBox PlacedBox(const std::string& line,
                      const RecordedFrame& recorded,
                      const PointsOfRun& run = {}) {
  return DetectionsOf(ReadDetectionLines(line, "d.jsonl").at(0), recorded, run, StraightTrack(),
                      0.0)
      .at(0);
}

const std::string kBoxAhead = R"({"center_m": [49, 0.5, -1], "size_m": [0.5, 0.4, 0.3]})";

// Points measured 0.05 s after the stamp were 1 m farther away at the stamp, at 20 m/s.
TEST(Detections, OfPointsAsMeasuredAreMovedToTheStamp) {
  const RecordedFrame recorded = FrameWithPoints({49.0, 0.5, -1.0}, 50'000'000);
  const DetectedBox box = PlacedBox(ReportedLine(kBoxAhead), recorded);
  EXPECT_TRUE(box.box.world_from_box.translation().isApprox(Vector3(550.0, 0.5, 1.0), 1e-9));
  EXPECT_EQ(box.box.size_m, Vector3(0.5, 0.4, 0.3));
  EXPECT_EQ(box.label, 5U);
}

TEST(Detections, OfCompensatedPointsStayWhereTheyAre) {
  const RecordedFrame recorded = FrameWithPoints({48.0, 0.5, -1.0}, 50'000'000);
  const DetectedBox box = PlacedBox(
      R"({"frame": 0, "compensate": "sensor", "detections": [)" + kBoxAhead + "]}\n", recorded);
  EXPECT_TRUE(box.box.world_from_box.translation().isApprox(Vector3(549.0, 0.5, 1.0), 1e-9));
  EXPECT_EQ(box.label, 5U);
}

/// A run whose files have their points in these axes, of a sensor 2 m ahead of the vehicle's origin
/// and 2.5 m above it.
PointsOfRun RunOf(OutputFrame frame, Handedness handedness = Handedness::kRight) {
  return {.output = {.frame = frame, .handedness = handedness, .origin_m = {500.0, 0.0, 0.0}},
          .vehicle_from_sensor = MakeTransform(Eigen::Matrix3d::Identity(), {2.0, 0.0, 2.5})};
}

std::string LineWith(const std::string& keys, const std::string& center_m) {
  return R"({"frame": 0, )" + keys + R"("detections": [{"center_m": )" + center_m +
         R"(, "size_m": [0.5, 0.4, 0.3]}]})" + "\n";
}

TEST(Detections, AreInTheAxesThatTheirLineSays) {
  const RecordedFrame recorded = FrameWithPoints({49.0, 0.5, -1.0}, 0);
  const auto is_there = [&](const std::string& line, const PointsOfRun& run) {
    return PlacedBox(line, recorded, run)
        .box.world_from_box.translation()
        .isApprox(Vector3(549.0, 0.5, 1.0), 1e-9);
  };
  EXPECT_TRUE(is_there(LineWith("", "[49, 0.5, -1]"), RunOf(OutputFrame::kSensor)));
  for (const OutputFrame files : {OutputFrame::kSensor, OutputFrame::kVehicle}) {
    const PointsOfRun run = RunOf(files);
    EXPECT_TRUE(is_there(LineWith(R"("axes": "sensor", )", "[49, 0.5, -1]"), run));
    EXPECT_TRUE(is_there(LineWith(R"("axes": "vehicle", )", "[51, 0.5, 1.5]"), run));
    EXPECT_TRUE(is_there(LineWith(R"("axes": "world", )", "[49, 0.5, 1]"), run));
  }
  const PointsOfRun left = RunOf(OutputFrame::kSensor, Handedness::kLeft);
  EXPECT_TRUE(is_there(LineWith(R"("handedness": "left", )", "[49, -0.5, -1]"), left));
  EXPECT_TRUE(is_there(LineWith(R"("handedness": "right", )", "[49, 0.5, -1]"), left));
}

TEST(Detections, MustSayTheirAxesWhereThePointsAreInOthers) {
  const RecordedFrame recorded = FrameWithPoints({49.0, 0.5, -1.0}, 0);
  const auto fault = [&](const std::string& line, const PointsOfRun& run) {
    return MessageOf([&] { (void)PlacedBox(line, recorded, run); });
  };
  EXPECT_EQ(fault(LineWith("", "[49, 0.5, -1]"), RunOf(OutputFrame::kVehicle)),
            "d.jsonl:1: /axes: missing, must be \"sensor\", \"vehicle\" or \"world\", as the boxes "
            "are: the points of the run's files are \"vehicle\"");
  EXPECT_EQ(fault(LineWith("", "[49, 0.5, -1]"), RunOf(OutputFrame::kSensor, Handedness::kLeft)),
            "d.jsonl:1: /handedness: missing, must be \"right\" or \"left\", as the boxes are: the "
            "points of the run's files are \"left\"");
  // Points say where they are by themselves.
  EXPECT_EQ(PlacedBox(ReportedLine(R"({"points": [0, 1]})"), recorded, RunOf(OutputFrame::kVehicle))
                .label,
            5U);
}

TEST(Detections, OfPointsAreTheirBox) {
  const RecordedFrame recorded = FrameWithPoints({49.0, 0.5, -1.0}, 50'000'000);
  const DetectedBox box =
      PlacedBox(ReportedLine(R"({"points": [0, 1, 2, 3, 4, 5, 6, 7]})"), recorded);
  EXPECT_TRUE(box.box.world_from_box.translation().isApprox(Vector3(550.0, 0.5, 1.0), 1e-6));
  EXPECT_TRUE(box.box.size_m.isApprox(Vector3(0.2, 0.2, 0.2), 1e-4));
  EXPECT_EQ(box.label, 5U);
}

TEST(Detections, NamePointsThatAreThere) {
  RecordedFrame recorded = FrameWithPoints({49.0, 0.5, -1.0}, 0);
  recorded.frame.x[3] = std::numeric_limits<float>::quiet_NaN();
  const auto fault = [&](const std::string& points) {
    return MessageOf(
        [&] { (void)PlacedBox(ReportedLine("{\"points\": " + points + "}"), recorded); });
  };
  EXPECT_EQ(fault("[0, 8]"),
            "d.jsonl:1: /detections/0/points/1: must be < 8, the number of points of frame.pcd "
            "(got 8)");
  EXPECT_EQ(fault("[3]"),
            "d.jsonl:1: /detections/0/points/0: must be a point, not a firing without one (got 3)");
}

TEST(Detections, BelowAScoreAreLeftOut) {
  const RecordedFrame recorded = FrameWithPoints({49.0, 0.5, -1.0}, 0);
  const ReportedFrame reported =
      ReadDetectionLines(
          ReportedLine(R"({"points": [0], "score": 0.4}, {"points": [1], "score": 0.5})"),
          "d.jsonl")
          .at(0);
  EXPECT_EQ(DetectionsOf(reported, recorded, {}, StraightTrack(), 0.5).size(), 1U);
}

}  // namespace
}  // namespace railcast
