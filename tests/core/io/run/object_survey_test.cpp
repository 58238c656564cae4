#include "core/io/run/object_survey.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/core/io/example_frame.h"

namespace railcast {
namespace {

// A wagon that moves east at 10 m/s, a wagon that no beam meets, and the sensor's own vehicle,
// which stands 2 m below the sensor of the frame below.
class TwoWagons final : public World {
 public:
  TwoWagons() {
    auto model = std::make_shared<Model>();
    // Its origin is not its centre: 4 x 2 x 3 m, from (0, -1, 0) to (4, 1, 3).
    model->parts.push_back({{{{0, -1, 0}, {4, 1, 0}, {4, 1, 3}}, {{0, 1, 2}}}, 1, 12});
    objects_ = {{"near", "tank_wagon", 12, 3, model, true, false},
                {"far", "box", 12, 9, model, false, false},
                {"ego", "box", 12, 10, model, false, true}};
  }
  [[nodiscard]] Transform WorldFromVehicle(std::int64_t) const override {
    return MakeTransform(RotationFromYawPitchRoll(std::numbers::pi / 2, 0, 0), Vector3(100, 0, 0));
  }
  [[nodiscard]] int HomeChunk(std::int64_t) const override { return 0; }
  [[nodiscard]] std::vector<int> ChunksInReach(int, double) const override { return {0}; }
  [[nodiscard]] Transform WorldFromChunk(int) const override { return Transform::Identity(); }
  [[nodiscard]] Chunk BuildChunk(int) const override { return {}; }
  [[nodiscard]] const std::vector<SceneObject>& objects() const override { return objects_; }
  [[nodiscard]] Transform WorldFromObject(std::size_t object, std::int64_t time_ns) const override {
    const double x_m = object == 0 ? 100.0 + 1e-8 * static_cast<double>(time_ns) : 500.0;
    return MakeTransform(Eigen::Matrix3d::Identity(), Vector3(x_m, 0, 0));
  }

 private:
  std::vector<SceneObject> objects_;
};

Frame FrameWithFiveFiringsOnInstanceThree() {
  Frame frame = ExampleFrame(2, 1, 8);
  frame.world_from_sensor =
      MakeTransform(RotationFromYawPitchRoll(std::numbers::pi / 2, 0, 0), Vector3(100, 0, 2));
  frame.world_from_sensor_end = frame.world_from_sensor;
  frame.duration_ns = 100'000'000;
  frame.instance.assign(8, 0);
  frame.outcome.assign(8, Outcome::kReturned);
  for (std::size_t slot = 0; slot < 5; ++slot) frame.instance[slot] = 3;
  frame.outcome[1] = Outcome::kBelowThreshold;
  return frame;
}

std::vector<ObjectInFrame> Survey(const Frame& frame,
                                  double range_max_m = 1000.0,
                                  const OutputSpec& output = {}) {
  const TwoWagons world;
  return ObjectSurvey(world, ExampleLabels(), range_max_m, output)
      .Describe(frame, {{10, 6, 160, 40}, {}, {7, 7, 7, 7}});
}

TEST(ObjectSurvey, CountsPointsAndLeavesOutTheOwnVehicle) {
  const auto objects = Survey(FrameWithFiveFiringsOnInstanceThree());
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].name, "near");
  EXPECT_EQ(objects[0].label, "wagon");
  EXPECT_EQ(objects[0].points, 4U);  // One of the five returns was too weak.
  EXPECT_EQ(objects[0].view, (ObjectView{10, 6, 160, 40}));
  EXPECT_EQ(objects[1].points, 0U);
  EXPECT_EQ(objects[1].view, ObjectView());
}

TEST(ObjectSurvey, PutsTheBoxWhereTheObjectIsAtTheStamp) {
  const auto objects = Survey(FrameWithFiveFiringsOnInstanceThree());
  EXPECT_EQ(objects[0].size_m, Vector3(4, 2, 3));
  // By 0.2 s it has moved 2 m; the centre of its box is 2 m ahead of its origin.
  EXPECT_TRUE(objects[0].world_from_box.translation().isApprox(Vector3(104, 0, 1.5), 1e-12));
}

TEST(ObjectSurvey, GivesTheVelocityOverTheScan) {
  Frame frame = FrameWithFiveFiringsOnInstanceThree();
  for (const std::uint32_t duration_ns : {100'000'000U, 0U}) {
    frame.duration_ns = duration_ns;
    const auto objects = Survey(frame);
    // Differences of positions near 100 m, rounded to 1.4e-14 m, over at least 1 ms.
    EXPECT_TRUE(objects[0].velocity_world_mps.isApprox(Vector3(10, 0, 0), 1e-10));
    EXPECT_EQ(objects[1].velocity_world_mps, Vector3::Zero());
  }
}

TEST(ObjectSurvey, GivesTheMeanTimeOfThePointsAlone) {
  Frame frame = FrameWithFiveFiringsOnInstanceThree();
  // Slot 1 has no point, and slots 5 to 7 are not on the object.
  frame.time_ns = {10, 4000, 20, 30, 41, 7000, 7000, 7000};
  EXPECT_EQ(Survey(frame)[0].points_time_ns, 25U);  // 25.25
  frame.time_ns.back() = 0;
  frame.outcome[4] = Outcome::kClutter;
  EXPECT_EQ(Survey(frame)[0].points_time_ns, 20U);
}

TEST(ObjectSurvey, CountsNoMirrorImages) {
  Frame frame = FrameWithFiveFiringsOnInstanceThree();
  frame.outcome[0] = Outcome::kClutter;
  EXPECT_EQ(Survey(frame)[0].points, 3U);
}

// The far box's centre is 402 m east and 0.5 m below; the radius of its sphere is sqrt(29) / 2 m.
TEST(ObjectSurvey, ListsWhatComesWithinRangeDuringTheScan) {
  const double nearest_m = std::hypot(402.0, 0.5) - std::sqrt(29.0) / 2.0;
  Frame frame = FrameWithFiveFiringsOnInstanceThree();
  EXPECT_EQ(Survey(frame, nearest_m - 0.001).size(), 1U);
  EXPECT_EQ(Survey(frame, nearest_m + 0.001).size(), 2U);
  // The sensor first moves 3 m towards the box; then it passes at a distance and is nearest on the
  // way.
  frame.world_from_sensor_end.translation() += Vector3(3, 0, 0);
  EXPECT_EQ(Survey(frame, nearest_m - 2.999).size(), 2U);
  EXPECT_EQ(Survey(frame, nearest_m - 3.001).size(), 1U);
  frame.world_from_sensor.translation() += Vector3(0, 300, 0);
  frame.world_from_sensor_end.translation() += Vector3(-3, -300, 0);
  EXPECT_EQ(Survey(frame, nearest_m + 0.001).size(), 2U);
  EXPECT_EQ(Survey(frame, nearest_m - 0.001).size(), 1U);
}

// The sensor faces left (north), so an object 4 m east of it is 4 m to its right. The x axis of the
// object's box points to the right as well; in left-handed axes, where y points to the right, its
// sign changes.
TEST(ObjectSurvey, GivesABoxInTheAxesOfThePoints) {
  struct Case {
    OutputSpec output;
    Vector3 center_m;
    Vector3 x_axis;
  };
  const Case cases[] = {
      {{OutputFrame::kSensor, Handedness::kRight}, {0, -4, -0.5}, {0, -1, 0}},
      {{OutputFrame::kSensor, Handedness::kLeft}, {0, 4, -0.5}, {0, 1, 0}},
      {{OutputFrame::kVehicle, Handedness::kRight}, {0, -4, 1.5}, {0, -1, 0}},
      {{OutputFrame::kVehicle, Handedness::kLeft}, {0, 4, 1.5}, {0, 1, 0}},
      {{OutputFrame::kWorld, Handedness::kRight}, {104, 0, 1.5}, {1, 0, 0}},
      {{OutputFrame::kWorld, Handedness::kRight, {100, 50, 1}}, {4, -50, 0.5}, {1, 0, 0}},
      {{OutputFrame::kWorld, Handedness::kLeft, {100, 50, 1}}, {4, 50, 0.5}, {1, 0, 0}}};
  for (const Case& expected : cases) {
    const auto objects = Survey(FrameWithFiveFiringsOnInstanceThree(), 1000.0, expected.output);
    const Transform& box = objects[0].output_from_box;
    EXPECT_LT((box.translation() - expected.center_m).norm(), 1e-12)
        << NameOf(expected.output.handedness) << " " << NameOf(expected.output.frame);
    EXPECT_LT((box.linear().col(0) - expected.x_axis).norm(), 1e-12);
    EXPECT_NEAR(box.linear().determinant(), 1.0, 1e-12);
  }
}

TEST(ObjectsLine, GivesBoxesVelocityAndOcclusion) {
  const Frame frame = FrameWithFiveFiringsOnInstanceThree();
  const auto line = nlohmann::json::parse(ObjectsLine(frame, Survey(frame)));
  EXPECT_EQ(line.at("stamp_ns"), 200'000'000);
  const auto& near = line.at("objects").at(0);
  EXPECT_EQ(near.at("firings_visible"), 6);
  EXPECT_EQ(near.at("firings_alone"), 10);
  EXPECT_EQ(near.at("occlusion"), 0.75);  // By the rays: 40 of 160 are visible.
  EXPECT_NEAR(near.at("velocity_mps").at(0).get<double>(), 10.0, 1e-9);
  for (const char* box : {"sensor", "output"}) {
    const auto centre = near.at(box).at("center_m").get<std::vector<double>>();
    EXPECT_NEAR(centre[0], 0.0, 1e-12);
    EXPECT_NEAR(centre[1], -4.0, 1e-12);
    EXPECT_NEAR(centre[2], -0.5, 1e-12);
  }
  EXPECT_EQ(near.at("world").at("center_m").at(0), 104.0);
  EXPECT_TRUE(line.at("objects").at(1).at("occlusion").is_null());
}

// Numbers of all lengths, -0 and text with what JSON escapes.
TEST(ObjectsLine, IsWhatAJsonLibraryWouldWrite) {
  const Frame frame = FrameWithFiveFiringsOnInstanceThree();
  std::vector<ObjectInFrame> objects = Survey(frame);
  objects[0].name = "n\u00e4her \"1\"\\\n\x7f";
  objects[0].size_m = Vector3(1e-9, 0.1 + 0.2, 1e22);
  objects[0].velocity_world_mps = Vector3(-0.0, 1.0 / 3.0, -123456.75);
  objects[0].contacts = {{"a\tb", true, -0.5}, {"plain", false, 0.0}};
  const std::string line = ObjectsLine(frame, objects);
  EXPECT_EQ(nlohmann::ordered_json::parse(line).dump() + "\n", line);
}

TEST(ObjectsLine, SaysWhatTouchesAnObject) {
  // The far object and the vehicle are the same flat model at the same place.
  const Frame frame = FrameWithFiveFiringsOnInstanceThree();
  const auto line = nlohmann::json::parse(ObjectsLine(frame, Survey(frame)));
  EXPECT_EQ(line.at("objects").at(0).at("contacts").dump(), "[]");
  EXPECT_EQ(line.at("objects").at(1).at("contacts").dump(),
            R"([{"gap_m":0.0,"overlap":false,"with":"ego"}])");
}

TEST(ObjectsLine, GivesGapsToATenthOfAMillimetre) {
  ObjectInFrame object{"one", "box", "object", 1};
  object.contacts = {{"other", true, -0.12345}, {"third", false, -1e-9}};
  const auto line =
      nlohmann::json::parse(ObjectsLine(FrameWithFiveFiringsOnInstanceThree(), {object}));
  EXPECT_EQ(line.at("objects").at(0).at("contacts").dump(),
            R"([{"gap_m":-0.1235,"overlap":true,"with":"other"},)"
            R"({"gap_m":0.0,"overlap":false,"with":"third"}])");
}

}  // namespace
}  // namespace railcast
