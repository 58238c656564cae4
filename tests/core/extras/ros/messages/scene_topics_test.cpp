#include "core/extras/ros/messages/scene_topics.h"

#include <gtest/gtest.h>

#include "tests/core/io/example_frame.h"

namespace railcast::ros {
namespace {

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
