#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "analysis/extras/detectors/reported_detections.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

using PlainJson = nlohmann::json;

/// One person, 20 m before a sensor that is turned by half a turn, 2 m before the vehicle's origin.
PlainJson SceneOfAPerson() {
  return PlainJson::parse(R"({"openlabel": {
    "metadata": {"schema_version": "1.0.0"},
    "coordinate_systems": {
      "base": {"type": "local", "parent": "", "children": ["lidar"]},
      "lidar": {"type": "sensor", "parent": "base", "pose_wrt_parent": {
        "translation": [2, 0, 0], "quaternion": [0, 0, 1, 0]}}},
    "objects": {"a": {"name": "person0001", "type": "person"}},
    "frames": {
      "10": {"objects": {"a": {"object_data": {"vec": [{"name": "lidar__vec__person", "val": [1]}]}}}},
      "9": {"objects": {"a": {"object_data": {"cuboid": [{"name": "lidar__cuboid__person",
        "coordinate_system": "lidar", "val": [20, 1, 0.9, 0, 0, 0, 1, 0.6, 0.5, 1.8]}]}}}},
      "11": {}}
  }})");
}

ReportedRun ReadScene(const PlainJson& scene, const Transform& vehicle_from_sensor) {
  return ReadOpenLabelRun(scene.dump(), "s.json", vehicle_from_sensor);
}

std::string SceneFault(const PlainJson& scene) {
  return MessageOf([&] { (void)ReadScene(scene, Transform::Identity()); });
}

TEST(OpenLabelDetections, AreCuboidsInTheSensorsAxes) {
  const Transform mount = MakeTransform(Eigen::Matrix3d::Identity(), Vector3(1.0, 0.0, 2.0));
  const ReportedRun run = ReadScene(SceneOfAPerson(), mount);
  // By rising number, whatever their order.
  ASSERT_EQ(run.size(), 3U);
  EXPECT_EQ(run[0].frame, 9U);
  EXPECT_EQ(run[1].frame, 10U);
  EXPECT_TRUE(run[1].detections.empty());
  EXPECT_TRUE(run[2].detections.empty());
  const ReportedDetection& person = run[0].detections.at(0);
  // In the vehicle's axes it is at (2 - 20, -1, 0.9).
  EXPECT_NEAR((*person.center_m)[0], -19.0, 1e-9);
  EXPECT_NEAR((*person.center_m)[1], -1.0, 1e-9);
  EXPECT_NEAR((*person.center_m)[2], -1.1, 1e-9);
  EXPECT_EQ(*person.size_m, (std::array{0.6, 0.5, 1.8}));
  EXPECT_NEAR(std::abs(person.quaternion_xyzw[2]), 1.0, 1e-9);
  EXPECT_EQ(person.class_name, "person");
  EXPECT_EQ(run[0].axes, OutputFrame::kSensor);
  EXPECT_EQ(run[0].handedness, Handedness::kRight);
  EXPECT_EQ(run[0].compensation, Compensation::kSensor);
}

TEST(OpenLabelDetections, AreReadStrictly) {
  const PlainJson::json_pointer cuboid("/openlabel/frames/9/objects/a/object_data/cuboid/0");
  PlainJson scene = SceneOfAPerson();
  scene[cuboid]["val"].erase(0);
  EXPECT_EQ(SceneFault(scene),
            "s.json: /openlabel/frames/9/objects/a/object_data/cuboid/0/val: must be 10 numbers");
  scene = SceneOfAPerson();
  scene[cuboid]["val"][8] = 0;
  EXPECT_EQ(SceneFault(scene),
            "s.json: /openlabel/frames/9/objects/a/object_data/cuboid/0/val: must end in three "
            "sizes > 0 and <= 1000");
  scene = SceneOfAPerson();
  scene[cuboid]["val"][0] = 1e9;
  EXPECT_EQ(SceneFault(scene),
            "s.json: /openlabel/frames/9/objects/a/object_data/cuboid/0/val: must be within 10000 "
            "km");
  scene = SceneOfAPerson();
  scene[cuboid]["coordinate_system"] = "radar";
  EXPECT_EQ(SceneFault(scene), "s.json: /openlabel/coordinate_systems/radar: missing");
  scene = SceneOfAPerson();
  scene["openlabel"]["coordinate_systems"]["base"]["parent"] = "lidar";
  scene["openlabel"]["coordinate_systems"]["base"]["pose_wrt_parent"] =
      scene["openlabel"]["coordinate_systems"]["lidar"]["pose_wrt_parent"];
  EXPECT_EQ(SceneFault(scene),
            "s.json: /openlabel/coordinate_systems/lidar: must not be above itself");
  scene = SceneOfAPerson();
  scene["openlabel"]["frames"]["first"] = PlainJson::object();
  EXPECT_EQ(SceneFault(scene), "s.json: /openlabel/frames/first: must be named by its number");
  scene = SceneOfAPerson();
  scene["openlabel"]["frames"]["009"] = PlainJson::object();
  EXPECT_EQ(SceneFault(scene), "s.json: /openlabel/frames/9: must be named once");
  EXPECT_EQ(MessageOf([] { (void)ReadOpenLabelRun("{", "s.json", Transform::Identity()); }),
            "s.json: must be a file of OpenLABEL");
}

// Published labels (OSDaR23) are read whole.
TEST(OpenLabelDetections, OfAPublishedSceneAreItsCuboids) {
  const std::filesystem::path file = std::filesystem::path(RAILCAST_SHARED_DATA_DIR) /
                                     "osdar23_openlabel" / "1_calibration_1.1_labels.json";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const ReportedRun run = ReadReportedRun(file, Transform::Identity());
  const PlainJson frames = PlainJson::parse(ReadFileWhole(file)).at("openlabel").at("frames");
  ASSERT_EQ(run.size(), frames.size());
  std::size_t num = 0;
  for (const ReportedFrame& frame : run) {
    std::size_t expected = 0;
    for (const PlainJson& object : frames.at(std::to_string(frame.frame)).at("objects")) {
      expected += object.at("object_data").value("cuboid", PlainJson::array()).size();
    }
    EXPECT_EQ(frame.detections.size(), expected);
    num += expected;
  }
  EXPECT_GT(num, 0U);
}

}  // namespace
}  // namespace railcast
