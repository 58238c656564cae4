#include "generator/object_record.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/core/io/example_frame.h"

namespace railcast {
namespace {

// A wagon that moves east at 10 m/s, a wagon that nobody sees, and the sensor's own vehicle.
class TwoWagons final : public World {
 public:
  TwoWagons() {
    auto model = std::make_shared<Model>();
    // Its origin is not its middle: 4 x 2 x 3 m, from (0, -1, 0) to (4, 1, 3).
    model->parts.push_back({{{{0, -1, 0}, {4, 1, 0}, {4, 1, 3}}, {{0, 1, 2}}}, 1, 12});
    objects_ = {{"near", "tank_wagon", 12, 3, model, true, false},
                {"far", "box", 12, 9, model, false, false},
                {"ego", "box", 12, 10, model, false, true}};
  }
  [[nodiscard]] Transform WorldFromVehicle(std::int64_t) const override {
    return Transform::Identity();
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
      MakeTransform(RotationFromYawPitchRoll(std::acos(-1.0) / 2, 0, 0), Vector3(100, 0, 2));
  frame.instance.assign(8, 0);
  frame.outcome.assign(8, Outcome::kReturned);
  for (std::size_t slot = 0; slot < 5; ++slot) frame.instance[slot] = 3;
  frame.outcome[1] = Outcome::kBelowThreshold;
  return frame;
}

TEST(DescribeObjects, CountsFiringsAndPointsAndLeavesOutTheOwnVehicle) {
  const auto objects = DescribeObjects(TwoWagons(), ExampleLabels(),
                                       FrameWithFiveFiringsOnInstanceThree(), {10, 0, 7});
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].name, "near");
  EXPECT_EQ(objects[0].label, "wagon");
  EXPECT_EQ(objects[0].firings_visible, 5U);
  EXPECT_EQ(objects[0].points, 4U);  // One of the five was too weak.
  EXPECT_EQ(objects[0].firings_alone, 10U);
  EXPECT_EQ(objects[1].firings_visible, 0U);
}

TEST(DescribeObjects, PutsTheBoxWhereTheObjectIsAtTheStamp) {
  const auto objects = DescribeObjects(TwoWagons(), ExampleLabels(),
                                       FrameWithFiveFiringsOnInstanceThree(), {10, 0, 7});
  EXPECT_EQ(objects[0].size_m, Vector3(4, 2, 3));
  // At 0.2 s it has moved 2 m; its box's centre is 2 m ahead of its origin.
  EXPECT_TRUE(objects[0].world_from_box.translation().isApprox(Vector3(104, 0, 1.5), 1e-12));
}

TEST(DescribeObjects, CountsAFiringWithTwoEchoesFromOneObjectOnce) {
  Frame frame = FrameWithFiveFiringsOnInstanceThree();
  frame.columns = 4;
  frame.returns = 2;
  const auto objects = DescribeObjects(TwoWagons(), ExampleLabels(), frame, {10, 0, 7});
  EXPECT_EQ(objects[0].firings_visible, 3U);
  EXPECT_EQ(objects[0].points, 4U);
}

TEST(ObjectsLine, GivesBoxesInBothFramesAndTheOcclusion) {
  const Frame frame = FrameWithFiveFiringsOnInstanceThree();
  const auto objects = DescribeObjects(TwoWagons(), ExampleLabels(), frame, {10, 0, 7});
  const auto line = nlohmann::json::parse(ObjectsLine(frame, objects));
  EXPECT_EQ(line.at("stamp_ns"), 200'000'000);
  const auto& near = line.at("objects").at(0);
  EXPECT_EQ(near.at("occlusion"), 0.5);
  // The sensor looks left (north): what lies 4 m east of it is 4 m to its right.
  const auto centre = near.at("sensor").at("center_m").get<std::vector<double>>();
  EXPECT_NEAR(centre[0], 0.0, 1e-12);
  EXPECT_NEAR(centre[1], -4.0, 1e-12);
  EXPECT_NEAR(centre[2], -0.5, 1e-12);
  EXPECT_TRUE(line.at("objects").at(1).at("occlusion").is_null());
}

}  // namespace
}  // namespace railcast
